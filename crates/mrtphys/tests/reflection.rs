//! Simultaneous impacts: what generalized reflections must do, and what they must survive.

use mrtphys::impact::reflection::{BUDGET, Group, GroupBody, GroupContact, Outcome, reflect};
use mrtphys::{Mat3, Real, Vec3};

fn ball(mass: Real, v: Vec3) -> GroupBody {
    GroupBody { inverse_mass: 1.0 / mass, inverse_inertia: Mat3::diagonal(Vec3::splat(2.5 / mass)), v, w: Vec3::ZERO }
}

/// Contact of two balls of radius 1.
fn touch(a: usize, b: usize, normal: Vec3) -> GroupContact {
    GroupContact { a, b: Some(b), normal, ra: normal, rb: -normal, restitution: 1.0, wall_velocity: Vec3::ZERO }
}

/// Contact of a ball of radius 1 with something fixed.
fn wall(a: usize, normal: Vec3) -> GroupContact {
    GroupContact { b: None, ..touch(a, 0, normal) }
}

fn run(bodies: &mut [GroupBody], contacts: &[GroupContact]) -> Outcome {
    reflect(Group { bodies, contacts }, BUDGET)
}

fn diagonal_solve(m: &Mat3, v: Vec3) -> Vec3 {
    // Tests use tensors of the form R diag R^T or diagonal; Cramer's rule is exact enough for both.
    let det = m.determinant();
    let c = m.c;
    Vec3::new(c[1].cross(c[2]).dot(v), c[2].cross(c[0]).dot(v), c[0].cross(c[1]).dot(v)) / det
}

fn energy(bodies: &[GroupBody]) -> Real {
    let one = |b: &GroupBody| {
        let spin = if b.inverse_inertia == Mat3::ZERO { 0.0 } else { b.w.dot(diagonal_solve(&b.inverse_inertia, b.w)) };
        if b.inverse_mass == 0.0 { 0.0 } else { 0.5 * b.v.length_squared() / b.inverse_mass + 0.5 * spin }
    };
    bodies.iter().map(one).sum()
}

fn momentum(bodies: &[GroupBody]) -> Vec3 {
    bodies.iter().filter(|b| b.inverse_mass > 0.0).map(|b| b.v / b.inverse_mass).sum()
}

/// Whether no contact approaches beyond round-off of the speeds.
fn separated(bodies: &[GroupBody], contacts: &[GroupContact]) -> bool {
    contacts.iter().all(|c| {
        let point = |b: &GroupBody, r: Vec3| (b.v + b.w.cross(r), b.v.length() + b.w.length() * r.length());
        let (va, sa) = point(&bodies[c.a], c.ra);
        let (vb, sb) = c.b.map_or((c.wall_velocity, c.wall_velocity.length()), |b| point(&bodies[b], c.rb));
        (va - vb).dot(c.normal) <= 1e-14 * (sa + sb)
    })
}

fn row(masses: &[Real], speeds: &[Real]) -> (Vec<GroupBody>, Vec<GroupContact>) {
    let bodies = masses.iter().zip(speeds).map(|(&m, &v)| ball(m, Vec3::X * v)).collect();
    (bodies, (1..masses.len()).map(|i| touch(i - 1, i, Vec3::X)).collect())
}

#[test]
fn cradle_lets_as_many_go_as_came() {
    for incoming in 1..=4 {
        let speeds: Vec<Real> = (0..5).map(|i| if i < incoming { 0.7 } else { 0.0 }).collect();
        let (mut bodies, contacts) = row(&[1.3; 5], &speeds);
        let out = run(&mut bodies, &contacts);
        assert!(out.decided);
        for (i, b) in bodies.iter().enumerate() {
            let expected = if i + incoming >= 5 { 0.7 } else { 0.0 };
            assert!((b.v - Vec3::X * expected).length() < 1e-15, "{incoming} in: ball {i} at {:?}", b.v);
            assert_eq!(b.w, Vec3::ZERO);
        }
    }
}

#[test]
fn unequal_cradle_keeps_energy_and_separates() {
    for masses in [[1.0, 2.0, 1.0, 5.0, 0.1], [1e8, 1.0, 1e-3, 1.0, 1e4], [1.0, 1e-4, 1.0, 1e-4, 1.0]] {
        let (mut bodies, contacts) = row(&masses, &[3.0, 0.0, 0.0, 0.0, -1.0]);
        let (e, p) = (energy(&bodies), momentum(&bodies));
        let out = run(&mut bodies, &contacts);
        assert!(out.decided && separated(&bodies, &contacts), "{masses:?} {out:?}");
        assert!((energy(&bodies) / e - 1.0).abs() < 1e-13);
        let size: Real = masses.iter().zip(&bodies).map(|(m, b)| m * b.v.length()).sum();
        assert!((momentum(&bodies) - p).length() < 1e-13 * size);
    }
}

#[test]
fn one_ball_between_two_touching_ones() {
    // The incoming ball's centre and the two others form an equilateral triangle.
    let h = libm::sqrt(0.75);
    let (up, down) = (Vec3::new(h, 0.5, 0.0), Vec3::new(h, -0.5, 0.0));
    let mut bodies = [ball(1.0, Vec3::X), ball(1.0, Vec3::ZERO), ball(1.0, Vec3::ZERO)];
    let contacts = [touch(0, 1, up), touch(0, 2, down), touch(1, 2, -Vec3::Y)];
    let out = run(&mut bodies, &contacts);
    assert!(out.decided && out.rounds == 1);
    assert!((bodies[0].v - Vec3::X * -0.2).length() < 1e-15);
    let speed = 0.4 * libm::sqrt(3.0);
    for (b, n) in [(bodies[1], up), (bodies[2], down)] {
        assert!((b.v - n * speed).length() < 1e-15, "30 degrees to either side");
    }
    let mirrored = Vec3::new(bodies[2].v.x, -bodies[2].v.y, 0.0);
    assert!((mirrored - bodies[1].v).length() <= 4.0 * Real::EPSILON);
}

/// A triangle of balls of radius 1 behind an apex at the origin, opened along x; the first body is the cue ball.
fn rack(rows: usize) -> (Vec<GroupBody>, Vec<GroupContact>, Vec<usize>) {
    let h = libm::sqrt(3.0);
    let mut bodies = vec![ball(1.0, Vec3::X)];
    let mut contacts = vec![touch(0, 1, Vec3::X)];
    let index = |row: usize, i: usize| 1 + row * (row + 1) / 2 + i;
    let mut mirror = vec![0];
    for row in 0..rows {
        for i in 0..=row {
            bodies.push(ball(1.0, Vec3::ZERO));
            mirror.push(index(row, row - i));
            if i > 0 {
                contacts.push(touch(index(row, i - 1), index(row, i), Vec3::Y));
            }
            if row + 1 < rows {
                contacts.push(touch(index(row, i), index(row + 1, i), Vec3::new(0.5 * h, -0.5, 0.0)));
                contacts.push(touch(index(row, i), index(row + 1, i + 1), Vec3::new(0.5 * h, 0.5, 0.0)));
            }
        }
    }
    (bodies, contacts, mirror)
}

#[test]
fn rack_breaks_mirror_symmetric() {
    let (mut bodies, contacts, mirror) = rack(5);
    assert_eq!((bodies.len(), contacts.len()), (16, 31));
    let out = run(&mut bodies, &contacts);
    assert!(out.decided && separated(&bodies, &contacts), "{out:?}");
    assert!((energy(&bodies) - 0.5).abs() < 1e-14);
    assert!((momentum(&bodies) - Vec3::X).length() < 1e-14);
    for (i, &m) in mirror.iter().enumerate() {
        let mirrored = Vec3::new(bodies[m].v.x, -bodies[m].v.y, 0.0);
        let error = (bodies[i].v - mirrored).length();
        assert!(error <= 16.0 * Real::EPSILON, "ball {i}: {error}");
    }
    // It is a break: the corners of the last row fly off.
    assert!(bodies[11].v.length() > 0.1 && bodies[15].v.length() > 0.1);
}

/// A unit cube of mass 1 on the plane y = 0, at its corners or inset towards the middle.
fn box_on_plane(inset: Real, v: Vec3, w: Vec3) -> ([GroupBody; 1], Vec<GroupContact>) {
    let cube = GroupBody { inverse_mass: 1.0, inverse_inertia: Mat3::diagonal(Vec3::splat(6.0)), v, w };
    let corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)];
    let contact =
        |(x, z): (Real, Real)| GroupContact { ra: Vec3::new(x * inset, -0.5, z * inset), ..wall(0, -Vec3::Y) };
    ([cube], corners.map(contact).to_vec())
}

#[test]
fn flat_box_bounces_without_spin() {
    for inset in [1.0, 0.75, 0.5, 0.1, 0.0] {
        let (mut bodies, contacts) = box_on_plane(inset, Vec3::new(0.3, -2.0, 0.1), Vec3::ZERO);
        let e = energy(&bodies);
        let out = run(&mut bodies, &contacts);
        assert!(out.decided);
        assert!((bodies[0].v - Vec3::new(0.3, 2.0, 0.1)).length() < 1e-15);
        assert!(bodies[0].w.length() < 1e-15, "{inset}: {:?}", bodies[0].w);
        assert!((energy(&bodies) / e - 1.0).abs() < 1e-15);
        assert!((out.impulses.iter().sum::<Real>() - 4.0).abs() < 1e-14);
    }
    // Tilting: still exact, and no corner goes on approaching.
    let (mut bodies, contacts) = box_on_plane(0.9, Vec3::new(0.0, -1.0, 0.0), Vec3::new(0.3, -1.0, 5.0));
    let e = energy(&bodies);
    assert!(run(&mut bodies, &contacts).decided && separated(&bodies, &contacts));
    assert!((energy(&bodies) / e - 1.0).abs() < 1e-14);
}

#[test]
fn heavy_on_light_keeps_energy() {
    for ratio in [1e2, 1e4, 1e6, 1e8] {
        // A heavy ball falls on three light ones on a floor.
        let mut bodies = vec![ball(ratio, -Vec3::Y)];
        let mut contacts = Vec::new();
        for k in 0..3 {
            let (s, c) = mrtphys::math::sin_cos(Real::from(k) * 2.0 * std::f64::consts::PI / 3.0);
            bodies.push(ball(1.0, Vec3::ZERO));
            let n = Vec3::new(0.6 * c, -0.8, 0.6 * s);
            contacts.push(touch(0, bodies.len() - 1, n));
            contacts.push(wall(bodies.len() - 1, -Vec3::Y));
        }
        let e = energy(&bodies);
        let out = run(&mut bodies, &contacts);
        assert!(out.decided && separated(&bodies, &contacts), "{ratio}");
        assert!((energy(&bodies) / e - 1.0).abs() < 1e-13, "{ratio}: {}", energy(&bodies) / e - 1.0);
    }
}

#[test]
fn ball_in_an_open_wedge_comes_out() {
    for angle in [1.0, 0.1, 1e-2, 1e-3] {
        let (s, c) = mrtphys::math::sin_cos(angle);
        let mut bodies = [ball(1.0, Vec3::new(-1.0, -0.01, 0.5))];
        // Walls y = 0 and one tilted by the angle over it; the ball flies into the edge.
        let contacts = [wall(0, -Vec3::Y), wall(0, Vec3::new(-s, c, 0.0))];
        let e = energy(&bodies);
        let out = run(&mut bodies, &contacts);
        assert!(out.decided && out.jammed == 0 && separated(&bodies, &contacts), "{angle}");
        assert!(out.rounds <= libm::ceil(std::f64::consts::PI / angle) as u64 + 1, "{angle}: {}", out.rounds);
        assert!((energy(&bodies) / e - 1.0).abs() < 1e-12);
        assert!((bodies[0].v.z - 0.5).abs() < 1e-15);
    }
}

#[test]
fn nearly_closed_wedge_ends_within_the_budget() {
    let mut bodies = [ball(1.0, Vec3::new(-1.0, -1.0, 0.0))];
    let contacts = [wall(0, -Vec3::Y), wall(0, Vec3::new(-1e-9, 1.0, 0.0).try_normalize().unwrap())];
    let e = energy(&bodies);
    let out = run(&mut bodies, &contacts);
    assert!(out.rounds <= BUDGET / 2 && out.jammed == 0);
    assert!((energy(&bodies) / e - 1.0).abs() < 1e-9, "{}", energy(&bodies) / e - 1.0);
    let out = reflect(Group { bodies: &mut bodies, contacts: &contacts }, 10);
    assert!(out.rounds <= 5);
}

#[test]
fn ball_jammed_between_walls_is_detected_and_the_rest_goes_on() {
    // Walls on both sides without a gap; the ball also runs into a third wall and into another ball.
    let mut bodies = [ball(1.0, Vec3::new(1.0, 1.0, 0.0)), ball(2.0, Vec3::new(-1.0, 0.0, 0.0))];
    let contacts = [wall(0, Vec3::Y), wall(0, -Vec3::Y), touch(0, 1, Vec3::X)];
    let e = energy(&bodies);
    let out = run(&mut bodies, &contacts);
    assert_eq!((out.decided, out.jammed), (false, 2), "{out:?}");
    assert!(out.rounds < 1000, "{}", out.rounds);
    assert!((energy(&bodies) / e - 1.0).abs() < 1e-13);
    // The head-on impact of 1 kg at 1 and 2 kg at -1 m/s: v1 = -5/3, v2 = 1/3.
    assert!((bodies[0].v.x + 5.0 / 3.0).abs() < 1e-13 && (bodies[1].v.x - 1.0 / 3.0).abs() < 1e-13);
    assert!((bodies[0].v.y.abs() - 1.0).abs() < 1e-13);
    // Three walls whose normals cancel, and a wedge that dissipates: that one comes to rest instead.
    let third = |k: Real| {
        let (s, c) = mrtphys::math::sin_cos(k * 2.0 * std::f64::consts::PI / 3.0);
        wall(0, Vec3::new(c, s, 0.0))
    };
    let mut bodies = [ball(1.0, Vec3::new(0.3, 0.1, 2.0))];
    let mut contacts = [third(0.0), third(1.0), third(2.0)];
    let out = run(&mut bodies, &contacts);
    assert_eq!((out.decided, out.jammed), (false, 3));
    for c in &mut contacts {
        c.restitution = 0.5;
    }
    let out = run(&mut bodies, &contacts);
    assert!(out.decided, "{out:?}");
    assert!((bodies[0].v - Vec3::new(0.0, 0.0, 2.0)).length() < 1e-14, "{:?}", bodies[0].v);
}

struct Random(u64);

impl Random {
    fn next(&mut self) -> Real {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as Real / (1u64 << 53) as Real
    }
    fn signed(&mut self) -> Real {
        2.0 * self.next() - 1.0
    }
    fn vec(&mut self) -> Vec3 {
        Vec3::new(self.signed(), self.signed(), self.signed())
    }
}

/// A random heap: rigid bodies with full tensors, contacts anywhere, mass ratio up to 1e4. The velocity of the first contact's
/// normal is such that there is something to do.
fn heap(random: &mut Random, bodies: usize, contacts: usize) -> (Vec<GroupBody>, Vec<GroupContact>) {
    let position: Vec<Vec3> = (0..bodies).map(|_| random.vec() * 3.0).collect();
    let list: Vec<GroupBody> = (0..bodies)
        .map(|_| {
            let m = libm::pow(10.0, 4.0 * random.next());
            let axes =
                mrtphys::Quat::new(random.signed(), random.signed(), random.signed(), 1.0).try_normalize().unwrap();
            let h = Vec3::new(random.next() + 0.2, random.next() + 0.2, random.next() + 0.2) * (0.2 * m);
            let inverse = Vec3::new(1.0 / (h.y + h.z), 1.0 / (h.z + h.x), 1.0 / (h.x + h.y));
            let inverse_inertia = axes.to_matrix().conjugate_diagonal(inverse);
            GroupBody { inverse_mass: 1.0 / m, inverse_inertia, v: random.vec(), w: random.vec() }
        })
        .collect();
    // Points and normals of bodies that lie on either side, so that they can all separate.
    let contacts = (0..contacts)
        .map(|k| {
            let a = k % bodies;
            let b = (a + 1 + (random.next() * (bodies - 1) as Real) as usize) % bodies;
            let normal = (position[b] - position[a]).try_normalize().unwrap();
            let point = position[a] + (position[b] - position[a]) * 0.5 + random.vec() * 0.2;
            let normal = (normal + random.vec() * 0.1).try_normalize().unwrap();
            GroupContact { ra: point - position[a], rb: point - position[b], ..touch(a, b, normal) }
        })
        .collect();
    (list, contacts)
}

/// A triangle of touching balls, of masses up to 1e4, that fly about anyhow.
fn pack(random: &mut Random, rows: usize) -> (Vec<GroupBody>, Vec<GroupContact>) {
    let (mut bodies, contacts, _) = rack(rows);
    for b in &mut bodies {
        *b = ball(libm::pow(10.0, 4.0 * random.next()), random.vec());
    }
    (bodies, contacts)
}

#[test]
fn random_heaps_keep_energy_and_momentum_and_end() {
    let mut random = Random(42);
    let mut most = 0;
    for k in 0..60 {
        let (n, m) = (2 + k % 9, 1 + (k * 7) % 60);
        let (mut bodies, contacts) = if k % 2 == 0 { heap(&mut random, n, m) } else { pack(&mut random, 2 + k % 7) };
        let (e, p) = (energy(&bodies), momentum(&bodies));
        let out = run(&mut bodies, &contacts);
        assert!(out.decided && separated(&bodies, &contacts), "{k}: {out:?}");
        assert!((energy(&bodies) / e - 1.0).abs() < 1e-13, "{k}: {}", energy(&bodies) / e - 1.0);
        let size: Real = bodies.iter().map(|b| b.v.length() / b.inverse_mass).sum();
        assert!((momentum(&bodies) - p).length() < 1e-13 * size);
        assert!(out.impulses.iter().all(|&j| j >= 0.0));
        most = most.max(out.rounds);
    }
    println!("most rounds: {most}");
    assert!(most > 5 && most < 10_000, "the heaps must need several rounds: {most}");
}

#[test]
fn impulses_explain_the_velocities() {
    let mut random = Random(7);
    let mut rounds = 0;
    for k in 0..20 {
        let (mut bodies, contacts) = if k % 2 == 0 { heap(&mut random, 6, 12) } else { pack(&mut random, 5) };
        let mut replay = bodies.clone();
        let out = run(&mut bodies, &contacts);
        rounds = rounds.max(out.rounds);
        for (c, &j) in contacts.iter().zip(&out.impulses) {
            for (k, r, j) in [(c.a, c.ra, c.normal * -j), (c.b.unwrap(), c.rb, c.normal * j)] {
                let body = &mut replay[k];
                body.v += j * body.inverse_mass;
                body.w += body.inverse_inertia * r.cross(j);
            }
        }
        for (a, b) in replay.iter().zip(&bodies) {
            assert!(
                (a.v - b.v).length() < 1e-12 * (1.0 + b.v.length())
                    && (a.w - b.w).length() < 1e-11 * (1.0 + b.w.length())
            );
        }
    }
    assert!(rounds > 5, "impulses of several rounds must have been added up: {rounds}");
}

#[test]
fn restitution_never_adds_energy_and_collapse_ends() {
    let mut random = Random(11);
    for k in 0..40 {
        let (mut bodies, mut contacts) = heap(&mut random, 3 + k % 6, 4 + k % 13);
        for c in &mut contacts {
            c.restitution = [0.0, 0.3, 0.9, 1.0][(random.next() * 4.0) as usize];
        }
        let (e, p) = (energy(&bodies), momentum(&bodies));
        let out = run(&mut bodies, &contacts);
        assert!(out.decided && separated(&bodies, &contacts), "{k} {out:?}");
        assert!(energy(&bodies) <= e * (1.0 + 1e-14));
        let size: Real = bodies.iter().map(|b| b.v.length() / b.inverse_mass).sum();
        assert!((momentum(&bodies) - p).length() < 1e-13 * size);
    }
    // One contact: -e times the approach speed. A chain of e = 0: all as one, in one round.
    let (mut pair, mut contacts) = row(&[1.0, 3.0], &[2.0, 0.0]);
    contacts[0].restitution = 0.25;
    run(&mut pair, &contacts);
    assert!((pair[1].v.x - pair[0].v.x - 0.5).abs() < 1e-15);
    let (mut chain, mut contacts) = row(&[1.0; 5], &[1.0, 0.0, 0.0, 0.0, 0.0]);
    for c in &mut contacts {
        c.restitution = 0.0;
    }
    let out = run(&mut chain, &contacts);
    assert!(out.decided && out.rounds == 1 && chain.iter().all(|b| (b.v.x - 0.2).abs() < 1e-15), "{chain:?}");
    // Collapse: a slow wall of balls with e = 0.1 against a heavy one; without a limit the bounces never end.
    let (mut chain, mut contacts) = row(&[1e3, 1.0, 1.0, 1.0, 1e3], &[1.0, 0.0, 0.0, 0.0, 0.0]);
    for c in &mut contacts {
        c.restitution = 0.1;
    }
    let out = run(&mut chain, &contacts);
    assert!(out.decided && out.rounds < 200 && separated(&chain, &contacts), "{out:?}");
}

#[test]
fn moving_wall_returns_the_ball_faster() {
    let mut bodies = [ball(1.0, Vec3::new(2.0, 0.5, 0.0))];
    let contacts = [GroupContact { wall_velocity: Vec3::new(-3.0, 9.0, 0.0), ..wall(0, Vec3::X) }];
    assert!(run(&mut bodies, &contacts).decided);
    assert!((bodies[0].v - Vec3::new(-8.0, 0.5, 0.0)).length() < 1e-14);
}

#[test]
fn small_budget_is_kept_and_reported() {
    let (mut bodies, contacts) = row(&[1.0; 40], &(0..40).map(|i| if i == 0 { 1.0 } else { 0.0 }).collect::<Vec<_>>());
    let out = reflect(Group { bodies: &mut bodies, contacts: &contacts }, 39 * 10);
    assert_eq!((out.decided, out.rounds), (false, 10));
    assert!((energy(&bodies) - 0.5).abs() < 1e-15);
    // The pi-billiard as one group: a light ball between a wall and a heavy one. 3142 impacts and more than the budget.
    let mut bodies = [ball(1.0, Vec3::ZERO), ball(1e10, -Vec3::X)];
    let contacts = [wall(0, -Vec3::X), touch(0, 1, Vec3::X)];
    let e = energy(&bodies);
    let out = reflect(Group { bodies: &mut bodies, contacts: &contacts }, 20_000);
    assert!(!out.decided && out.rounds == 10_000 && out.jammed == 0);
    assert!((energy(&bodies) / e - 1.0).abs() < 1e-11);
    let mut bodies = [ball(1.0, Vec3::ZERO), ball(1e4, -Vec3::X)];
    let out = run(&mut bodies, &contacts);
    assert!(out.decided && separated(&bodies, &contacts));
}

#[test]
fn what_is_not_finite_is_left_alone() {
    // The last three overflow on the way.
    for (speed, other) in
        [(Real::NAN, 0.0), (Real::INFINITY, 0.0), (Real::MAX, -Real::MAX), (1e153, -1e153), (1e300, 0.0)]
    {
        let (mut bodies, contacts) = row(&[1e10, 1e10, 1e-3], &[speed, other, 0.0]);
        let before = format!("{bodies:?}");
        let out = run(&mut bodies, &contacts);
        assert_eq!(format!("{bodies:?}"), before);
        assert_eq!(out, Outcome { impulses: vec![0.0; 2], ..Outcome::default() });
    }
    // The other end: what underflows is still answered.
    let (mut bodies, contacts) = row(&[1.0, 1.0], &[1e-200, 0.0]);
    assert!(run(&mut bodies, &contacts).decided);
    assert_eq!([bodies[0].v.x, bodies[1].v.x], [0.0, 1e-200]);
    let fixed = GroupBody { inverse_mass: 0.0, inverse_inertia: Mat3::ZERO, v: Vec3::ZERO, w: Vec3::ZERO };
    let mut both = [fixed, fixed];
    assert!(run(&mut both, &[touch(0, 1, Vec3::X), wall(0, Vec3::Y)]).decided);
    assert!(run(&mut both, &[]).decided);
    // A ball against a body that never moves is a ball against a wall.
    let mut pair = [ball(1.0, Vec3::X), fixed];
    run(&mut pair, &[touch(0, 1, Vec3::X)]);
    assert_eq!((pair[0].v, pair[1]), (-Vec3::X, fixed));
}

#[test]
fn one_contact_many_times_is_one_contact() {
    let n = Vec3::new(1.0, 2.0, -0.5).try_normalize().unwrap();
    let start = [ball(1.0, Vec3::new(1.0, 1.0, 0.0)), ball(3.0, Vec3::ZERO)];
    let mut one = start;
    run(&mut one, &[touch(0, 1, n)]);
    let mut many = start;
    assert!(run(&mut many, &[touch(0, 1, n); 7]).decided);
    for (a, b) in one.iter().zip(&many) {
        assert!((a.v - b.v).length() < 1e-15);
    }
}

#[test]
fn powers_of_two_pass_through_exactly() {
    let mut random = Random(3);
    for k in [-40, -3, 1, 40] {
        let s = libm::ldexp(1.0, k);
        for mass in [1.0, s * s * s] {
            let (mut bodies, mut contacts) = heap(&mut random, 7, 15);
            for (i, c) in contacts.iter_mut().enumerate() {
                c.restitution = if i % 3 == 0 { 0.8 } else { 1.0 };
            }
            let inertia = 1.0 / (mass * s * s);
            let scale = |b: &GroupBody| {
                let c = b.inverse_inertia.c;
                GroupBody {
                    inverse_mass: b.inverse_mass / mass,
                    inverse_inertia: Mat3::from_columns(c[0] * inertia, c[1] * inertia, c[2] * inertia),
                    v: b.v * s,
                    w: b.w,
                }
            };
            let mut big: Vec<GroupBody> = bodies.iter().map(scale).collect();
            let large: Vec<GroupContact> =
                contacts.iter().map(|c| GroupContact { ra: c.ra * s, rb: c.rb * s, ..*c }).collect();
            let (one, two) = (run(&mut bodies, &contacts), run(&mut big, &large));
            let expected: Vec<GroupBody> = bodies.iter().map(scale).collect();
            assert_eq!(big, expected);
            assert_eq!(one.rounds, two.rounds);
            let impulses: Vec<Real> = one.impulses.iter().map(|j| j * s * mass).collect();
            assert_eq!(two.impulses, impulses);
        }
    }
}

/// A crystal of n^3 touching balls, squeezed: every contact approaches at once.
fn crystal(n: usize) -> (Vec<GroupBody>, Vec<GroupContact>) {
    let index = |i: usize, j: usize, k: usize| (i * n + j) * n + k;
    let mut random = Random(5);
    let (mut bodies, mut contacts) = (Vec::new(), Vec::new());
    for i in 0..n {
        for j in 0..n {
            for k in 0..n {
                let x = Vec3::new(i as Real, j as Real, k as Real) - Vec3::splat(0.5 * (n - 1) as Real);
                bodies.push(ball(1.0, x * -0.2 + random.vec()));
                for (more, next, d) in [
                    (i + 1 < n, index((i + 1).min(n - 1), j, k), Vec3::X),
                    (j + 1 < n, index(i, (j + 1).min(n - 1), k), Vec3::Y),
                    (k + 1 < n, index(i, j, (k + 1).min(n - 1)), Vec3::Z),
                ] {
                    if more {
                        contacts.push(touch(index(i, j, k), next, d));
                    }
                }
            }
        }
    }
    (bodies, contacts)
}

#[test]
fn large_groups_end_in_bounded_time() {
    for n in [4, 5, 10] {
        let (mut bodies, contacts) = crystal(n);
        let (e, p) = (energy(&bodies), momentum(&bodies));
        let start = std::time::Instant::now();
        let out = run(&mut bodies, &contacts);
        println!("{} contacts: {} rounds, {:?}, decided {}", contacts.len(), out.rounds, start.elapsed(), out.decided);
        assert!((energy(&bodies) / e - 1.0).abs() < 1e-12);
        assert!((momentum(&bodies) - p).length() < 1e-11 * bodies.len() as Real);
        assert!(out.rounds <= BUDGET / contacts.len() as u64 + 1);
        assert!(!out.decided || separated(&bodies, &contacts));
    }
}
