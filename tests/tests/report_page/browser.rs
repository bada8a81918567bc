//! A browser that opens one report and answers questions in JavaScript. It counts what a report must not do: errors on the
//! console, and requests beyond the file.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use headless_chrome::browser::tab::point::Point;
use headless_chrome::protocol::cdp::types::Event;
use headless_chrome::protocol::cdp::{Input, Network, Runtime};
use headless_chrome::{Browser, LaunchOptions, Tab};
use serde_json::Value;

/// Names of the browsers that may be on the path.
const NAMES: [&str; 5] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome"];

/// Variable that makes a missing browser a failure: continuous integration installs one.
const REQUIRED: &str = "RAYPENCIL_NEEDS_BROWSER";

/// Longest wait for something to happen on a page, seconds. Pages take a second or two; machines may be busy.
const PATIENCE_S: u64 = 90;

/// Path of a browser: that of the variable `CHROME`, or one on the path.
fn installed() -> Option<PathBuf> {
    if let Some(chosen) = std::env::var_os("CHROME") {
        return Some(chosen.into());
    }
    let path = std::env::var_os("PATH")?;
    std::env::split_paths(&path)
        .flat_map(|folder| NAMES.map(|name| folder.join(name)))
        .find(|file| file.is_file())
}

/// One page in a browser of its own.
pub struct Page {
    tab: Arc<Tab>,
    trouble: Arc<Mutex<Vec<String>>>,
    requests: Arc<Mutex<Vec<String>>>,
    _browser: Browser,
}

/// Opens a file, with `#hash` or nothing behind it, in a window of that size. `None`, and words on the terminal, if no
/// browser is installed.
pub fn open(file: &Path, hash: &str, size: (u32, u32)) -> Option<Page> {
    let Some(path) = installed() else {
        assert!(std::env::var_os(REQUIRED).is_none(), "no browser is installed, and {REQUIRED} asks for one");
        eprintln!("skipped: no browser is installed ({})", NAMES.join(", "));
        return None;
    };
    // Graphics by software: what is drawn has to be right on any machine.
    let arguments =
        ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--hide-scrollbars"];
    let options = LaunchOptions {
        path: Some(path),
        // Test machines often run as root, where the sandbox does not start. The page is our own.
        sandbox: false,
        window_size: Some(size),
        enable_gpu: true,
        args: arguments.iter().map(OsStr::new).collect(),
        idle_browser_timeout: Duration::from_secs(600),
        ..LaunchOptions::default()
    };
    let browser = Browser::new(options).expect("the browser starts");
    let tab = browser.new_tab().expect("a tab");
    tab.set_default_timeout(Duration::from_secs(PATIENCE_S));
    let trouble = Arc::new(Mutex::new(Vec::new()));
    let requests = Arc::new(Mutex::new(Vec::new()));
    tab.enable_log().expect("the log");
    tab.enable_runtime().expect("the console");
    tab.call_method(Network::Enable {
        max_total_buffer_size: None,
        max_resource_buffer_size: None,
        max_post_data_size: None,
        report_direct_socket_traffic: None,
        enable_durable_messages: None,
    })
    .expect("the network");
    let (of_trouble, of_requests) = (Arc::clone(&trouble), Arc::clone(&requests));
    tab.add_event_listener(Arc::new(move |event: &Event| match event {
        Event::RuntimeExceptionThrown(thrown) => {
            of_trouble.lock().unwrap().push(format!("{:?}", thrown.params.exception_details));
        }
        Event::RuntimeConsoleAPICalled(called) => {
            if matches!(called.params.Type, Runtime::ConsoleAPICalledEventTypeOption::Error) {
                of_trouble.lock().unwrap().push(format!("{:?}", called.params.args));
            }
        }
        Event::LogEntryAdded(added) => {
            let text = format!("{:?}", added.params.entry);
            if text.contains("Error") {
                of_trouble.lock().unwrap().push(text);
            }
        }
        Event::NetworkRequestWillBeSent(sent) => {
            of_requests.lock().unwrap().push(sent.params.request.url.clone());
        }
        _ => {}
    }))
    .expect("a listener");
    let address = format!("file://{}{hash}", file.canonicalize().expect("the file").display());
    tab.navigate_to(&address).expect("the page");
    tab.wait_until_navigated().expect("the page is there");
    Some(Page { tab, trouble, requests, _browser: browser })
}

impl Page {
    /// The value of a JavaScript expression; promises are waited for.
    pub fn ask(&self, expression: &str) -> Value {
        // As JSON text, since only plain values come through as they are.
        let asked = format!("(async () => JSON.stringify(await ({expression})))()");
        let found = self.tab.evaluate(&asked, true).unwrap_or_else(|error| panic!("{expression}: {error}"));
        match found.value {
            Some(Value::String(text)) => serde_json::from_str(&text).expect("JSON"),
            _ => Value::Null,
        }
    }

    /// The number that an expression gives.
    pub fn number(&self, expression: &str) -> f64 {
        self.ask(expression).as_f64().unwrap_or_else(|| panic!("{expression} is no number"))
    }

    /// The text that an expression gives.
    pub fn text(&self, expression: &str) -> String {
        let found = self.ask(expression);
        found.as_str().unwrap_or_else(|| panic!("{expression} is {found}")).to_string()
    }

    /// Waits until an expression is true.
    pub fn wait(&self, expression: &str) {
        let start = Instant::now();
        while self.ask(expression) != Value::Bool(true) {
            let waited = start.elapsed();
            assert!(waited.as_secs() < PATIENCE_S, "never: {expression}; {:?}", self.trouble.lock().unwrap());
            std::thread::sleep(Duration::from_millis(30));
        }
    }

    /// Moves the mouse to a place of the window, CSS pixels.
    pub fn point_at(&self, x: f64, y: f64) {
        self.tab.move_mouse_to_point(Point { x, y }).expect("the mouse moves");
    }

    /// Clicks at a place of the window, CSS pixels.
    pub fn click_at(&self, x: f64, y: f64) {
        self.tab.click_point(Point { x, y }).expect("a click");
    }

    /// Clicks in the middle of the element that a selector finds.
    pub fn click(&self, selector: &str) {
        let element = format!("document.querySelector({})", Value::from(selector));
        self.ask(&format!("{element}.scrollIntoView({{block: 'center'}})"));
        let place = self.ask(&format!(
            "(r => [r.x + r.width / 2, r.y + r.height / 2])({element}.getBoundingClientRect())"
        ));
        let at = |k: usize| place[k].as_f64().expect("a place");
        self.click_at(at(0), at(1));
    }

    /// Presses a key by its name, such as `Tab` or `f`.
    pub fn press(&self, key: &str) {
        self.tab.press_key(key).unwrap_or_else(|error| panic!("{key}: {error}"));
    }

    /// Presses a letter that the driver has no code for, such as `?`.
    pub fn press_letter(&self, letter: &str) {
        for kind in [Input::DispatchKeyEventTypeOption::KeyDown, Input::DispatchKeyEventTypeOption::KeyUp] {
            let event = Input::DispatchKeyEvent {
                Type: kind,
                key: Some(letter.into()),
                text: Some(letter.into()),
                modifiers: None,
                timestamp: None,
                unmodified_text: None,
                key_identifier: None,
                code: None,
                windows_virtual_key_code: None,
                native_virtual_key_code: None,
                auto_repeat: None,
                is_keypad: None,
                is_system_key: None,
                location: None,
                commands: None,
            };
            self.tab.call_method(event).expect("a key");
        }
    }

    /// Asserts that nothing went wrong so far, and that nothing but the file itself was asked for.
    pub fn assert_quiet(&self) {
        let trouble = self.trouble.lock().unwrap();
        assert!(trouble.is_empty(), "{trouble:#?}");
        let requests = self.requests.lock().unwrap();
        let beyond: Vec<&String> =
            requests.iter().filter(|url| !url.starts_with("file://") && !url.starts_with("data:")).collect();
        let files = requests.iter().filter(|url| url.starts_with("file://")).count();
        assert!(beyond.is_empty() && files <= 1, "{requests:?}");
    }
}
