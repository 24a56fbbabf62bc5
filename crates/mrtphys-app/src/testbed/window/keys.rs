//! Keys: one table for what they do and what the help says.

use super::action::Action;
use eframe::egui::{Context, Key, KeyboardShortcut, Modifiers};

/// A key, what it does, and how the help names it.
pub struct Shortcut {
    /// what is pressed
    pub keys: &'static [KeyboardShortcut],
    /// as the help writes it
    pub name: &'static str,
    /// what is done
    pub action: Action,
    /// as the help says it
    pub text: &'static str,
}

const fn plain(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::NONE, key)
}

const fn command(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::COMMAND, key)
}

const fn shift(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::SHIFT, key)
}

macro_rules! shortcuts {
    ($($keys:expr, $name:literal, $action:expr, $text:literal;)+) => {
        &[$(Shortcut { keys: &$keys, name: $name, action: $action, text: $text }),+]
    };
}

/// All of them. Those with a modifier come before the same key without one.
pub const SHORTCUTS: &[Shortcut] = shortcuts![
    [plain(Key::Space)], "Space", Action::Go, "Go or stop";
    [plain(Key::ArrowRight)], "Right", Action::Step, "One frame forward";
    [plain(Key::ArrowLeft)], "Left", Action::Back, "One frame back";
    [plain(Key::Period)], ".", Action::PhysicalStep, "One physical step forward";
    [plain(Key::Home)], "Home", Action::First, "First frame of the recording";
    [plain(Key::End)], "End", Action::Last, "Last frame of the recording";
    [command(Key::R), plain(Key::F5)], "Ctrl+R, F5", Action::Reload, "Read the scene again";
    [plain(Key::R)], "R", Action::Restart, "Begin again with the scene as it was loaded";
    [command(Key::O)], "Ctrl+O", Action::OpenFile, "Open a scene";
    [plain(Key::G)], "G", Action::Gallery, "Gallery";
    [command(Key::S)], "Ctrl+S", Action::SaveScene, "Save the present state as a scene";
    [command(Key::P), plain(Key::F12)], "Ctrl+P, F12", Action::Screenshot, "Picture";
    [command(Key::M)], "Ctrl+M", Action::Film, "Film";
    [plain(Key::C)], "C", Action::ResetCamera, "The scene's camera";
    [plain(Key::F)], "F", Action::FitCamera, "Everything into the picture";
    [plain(Key::T)], "T", Action::Theme, "Light or dark";
    [command(Key::Plus), command(Key::Equals)], "Ctrl++", Action::Scale(1), "Larger letters";
    [command(Key::Minus)], "Ctrl+-", Action::Scale(-1), "Smaller letters";
    [command(Key::Num0)], "Ctrl+0", Action::Scale(0), "Letters as at first";
    [plain(Key::F9)], "F9", Action::SidePanel, "Show or hide the panel";
    [plain(Key::F8)], "F8", Action::Below, "Show or hide the plots";
    [plain(Key::F1), plain(Key::Questionmark), shift(Key::Questionmark), shift(Key::Slash)], "F1, ?", Action::Help, "Help";
    [command(Key::Q)], "Ctrl+Q", Action::Quit, "Quit";
];

/// What the keys ask for that were pressed since the last picture. Nothing while a text is being typed: letters belong there.
pub fn pressed(context: &Context) -> Vec<Action> {
    let typing = context.text_edit_focused();
    context.input_mut(|input| {
        let mut wanted = Vec::new();
        for shortcut in SHORTCUTS {
            for keys in shortcut.keys {
                if typing && !keys.modifiers.command {
                    continue;
                }
                for _ in 0..input.count_and_consume_key(keys.modifiers, keys.logical_key) {
                    wanted.push(shortcut.action.clone());
                }
            }
        }
        wanted
    })
}

/// The key of an action, for menus; empty if there is none.
pub fn name_of(action: &Action) -> &'static str {
    SHORTCUTS.iter().find(|s| s.action == *action).map_or("", |s| s.name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::{Event, RawInput};

    fn press(keys: &[(Modifiers, Key)]) -> Vec<Action> {
        let context = Context::default();
        let events = keys.iter().map(|&(modifiers, key)| Event::Key {
            key,
            physical_key: None,
            pressed: true,
            repeat: false,
            modifiers,
        });
        let input = RawInput { events: events.collect(), ..RawInput::default() };
        let mut wanted = Vec::new();
        let mut output = context.run_ui(input, |ui| wanted.extend(pressed(ui.ctx())));
        // Nobody uploads the letters of a test.
        output.textures_delta.clear();
        wanted
    }

    #[test]
    fn keys_do_what_the_help_says() {
        assert_eq!(press(&[(Modifiers::NONE, Key::Space)]), [Action::Go]);
        assert_eq!(press(&[(Modifiers::NONE, Key::R)]), [Action::Restart]);
        assert_eq!(press(&[(Modifiers::COMMAND, Key::R)]), [Action::Reload]);
        assert_eq!(press(&[(Modifiers::SHIFT, Key::Questionmark)]), [Action::Help]);
        assert_eq!(press(&[(Modifiers::NONE, Key::X)]), []);
        let twice = [(Modifiers::NONE, Key::ArrowRight); 2];
        assert_eq!(press(&twice), [Action::Step, Action::Step], "every stroke counts");
    }

    #[test]
    fn no_key_means_two_things() {
        let all: Vec<&KeyboardShortcut> = SHORTCUTS.iter().flat_map(|s| s.keys).collect();
        for (i, a) in all.iter().enumerate() {
            assert!(all[..i].iter().all(|b| a != b), "{a:?}");
        }
        assert_eq!(name_of(&Action::Help), "F1, ?");
    }
}
