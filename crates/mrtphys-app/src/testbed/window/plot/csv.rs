//! Everything that was plotted, as a table for other programs.

use super::trace::Moment;
use mrtphys::counters::Counters;
use mrtphys::ledger::Ledger;
use std::fmt::Write;

/// One line a moment, SI units, every digit.
pub fn csv(moments: &[Moment]) -> String {
    let mut text = String::from("tick,time_s,linear_J,rotational_J,potential_J,total_J,initial_J");
    for (name, _) in Ledger::default().entries() {
        let _ = write!(text, ",{name}_J");
    }
    text += ",px_Ns,py_Ns,pz_Ns,Lx_Js,Ly_Js,Lz_Js,frames,steps,duration_s,cost_s";
    for name in Counters::NAMES {
        let _ = write!(text, ",{name}");
    }
    text.push('\n');
    for m in moments {
        let e = m.energy;
        let _ = write!(text, "{}", m.tick);
        let mut numbers = vec![m.time, e.linear, e.rotational, e.potential, e.total(), m.initial_energy.total()];
        numbers.extend(m.ledger.entries().map(|e| e.1));
        numbers.extend(m.momentum.to_array());
        numbers.extend(m.angular_momentum.to_array());
        for x in numbers {
            let _ = write!(text, ",{x:?}");
        }
        let _ = write!(text, ",{},{},{:?},{:?}", m.frames, m.steps, m.duration, m.cost.as_secs_f64());
        for n in m.counts.to_array() {
            let _ = write!(text, ",{n}");
        }
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_has_every_column_and_every_digit() {
        let m = Moment { tick: 3, time: 0.1 + 0.2, steps: 8, ..Moment::default() };
        let text = csv(&[m.clone(), m]);
        let lines: Vec<Vec<&str>> = text.lines().map(|l| l.split(',').collect()).collect();
        assert_eq!(lines.len(), 3);
        assert!(lines.iter().all(|l| l.len() == lines[0].len()));
        assert_eq!((lines[1][0], lines[1][1]), ("3", "0.30000000000000004"));
        let column = lines[0].iter().position(|c| *c == "steps").unwrap();
        assert_eq!(lines[2][column], "8");
    }
}
