//! A browser that opens one report and answers questions in JavaScript, by way of ChromeDriver and the WebDriver protocol
//! (W3C). It keeps what a report must not do: errors on the console, and requests beyond the file.

use std::cell::RefCell;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

/// Names of the browsers that may be on the path.
const BROWSERS: [&str; 5] =
    ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome"];

/// Name of the program between a test and the browser.
const DRIVER: &str = "chromedriver";

/// Variable that makes a missing browser a failure: continuous integration installs one.
const REQUIRED: &str = "RAYPENCIL_NEEDS_BROWSER";

/// Longest wait for something to happen on a page, seconds. Pages take a second or two; machines may be busy.
const PATIENCE_S: u64 = 90;

/// Of the browser. Graphics by software: what is drawn has to be right on any machine. Test machines often run as root,
/// where the sandbox does not start; the page is our own. The last three keep the browser from calling its maker.
const ARGUMENTS: [&str; 10] = [
    "--headless=new",
    "--no-sandbox",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--hide-scrollbars",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
];

/// The first of these programs that is on the path.
fn on_path(names: &[&str]) -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    std::env::split_paths(&path)
        .flat_map(|folder| names.iter().map(move |name| folder.join(name)))
        .find(|file| file.is_file())
}

/// The browser, that of the variable `CHROME` or one on the path, and its driver.
fn installed() -> Option<(PathBuf, PathBuf)> {
    let browser = std::env::var_os("CHROME").map(PathBuf::from).or_else(|| on_path(&BROWSERS))?;
    Some((browser, on_path(&[DRIVER])?))
}

/// A driver that runs, on a port of its own, until it is dropped.
struct Driver {
    process: Child,
    address: String,
    agent: ureq::Agent,
}

impl Driver {
    fn start(program: &Path) -> Self {
        let mut process = Command::new(program)
            .arg("--port=0")
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("the driver starts");
        let mut lines = BufReader::new(process.stdout.take().expect("a pipe")).lines();
        // "ChromeDriver was started successfully on port 41735."
        let port = lines
            .by_ref()
            .map_while(Result::ok)
            .find_map(|line| {
                Some(line.split_once("successfully on port ")?.1.trim_end_matches('.').to_string())
            })
            .expect("the driver says its port");
        // A pipe that nobody reads would stop it.
        std::thread::spawn(move || lines.for_each(drop));
        let agent = ureq::Agent::config_builder()
            .http_status_as_error(false)
            .timeout_global(Some(Duration::from_secs(2 * PATIENCE_S)))
            .build()
            .into();
        Self { process, address: format!("http://127.0.0.1:{port}"), agent }
    }

    /// The value of an answer to a command.
    fn command(&self, path: &str, body: &Value) -> Result<Value, String> {
        let answer = self
            .agent
            .post(format!("{}{path}", self.address))
            .send_json(body)
            .and_then(|mut answer| answer.body_mut().with_config().limit(1 << 30).read_json::<Value>())
            .map_err(|error| error.to_string())?;
        match answer["value"]["error"].as_str() {
            Some(error) => Err(format!("{error}: {}", answer["value"]["message"])),
            None => Ok(answer["value"].clone()),
        }
    }
}

impl Drop for Driver {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

/// One page in a browser of its own.
pub struct Page {
    driver: Driver,
    /// Path of the session's commands.
    session: String,
    trouble: RefCell<Vec<String>>,
    requests: RefCell<Vec<String>>,
}

/// Opens a file, with `#hash` or nothing behind it, in a window of that size. `None`, and words on the terminal, if no
/// browser is installed.
pub fn open(file: &Path, hash: &str, size: (u32, u32)) -> Option<Page> {
    let Some((browser, driver)) = installed() else {
        assert!(
            std::env::var_os(REQUIRED).is_none(),
            "no browser with {DRIVER}, and {REQUIRED} asks for one"
        );
        eprintln!("skipped: no browser ({}) with {DRIVER} is installed", BROWSERS.join(", "));
        return None;
    };
    let driver = Driver::start(&driver);
    let wanted = json!({ "capabilities": { "alwaysMatch": {
        "browserName": "chrome",
        "goog:chromeOptions": { "binary": browser, "args": ARGUMENTS },
        "goog:loggingPrefs": { "browser": "ALL", "performance": "ALL" },
        "timeouts": { "script": 1000 * PATIENCE_S, "pageLoad": 1000 * PATIENCE_S },
    }}});
    let started = driver.command("/session", &wanted).expect("the browser starts");
    let session = format!("/session/{}", started["sessionId"].as_str().expect("a session"));
    let page = Page { driver, session, trouble: RefCell::default(), requests: RefCell::default() };
    let window = json!({ "width": size.0, "height": size.1, "deviceScaleFactor": 1, "mobile": false });
    page.devtools("Emulation.setDeviceMetricsOverride", &window);
    let address = format!("file://{}{hash}", file.canonicalize().expect("the file").display());
    page.command("/url", &json!({ "url": address }));
    Some(page)
}

impl Page {
    fn command(&self, path: &str, body: &Value) -> Value {
        let found = self.driver.command(&format!("{}{path}", self.session), body);
        found.unwrap_or_else(|error| panic!("{path} {body}: {error}"))
    }

    /// A command of the DevTools protocol.
    pub fn devtools(&self, command: &str, parameters: &Value) -> Value {
        self.command("/goog/cdp/execute", &json!({ "cmd": command, "params": parameters }))
    }

    /// Runs a script in the page.
    pub fn run(&self, script: &str) {
        self.command("/execute/sync", &json!({ "script": script, "args": [] }));
    }

    /// The value of a JavaScript expression; promises are waited for.
    pub fn ask(&self, expression: &str) -> Value {
        // As JSON text: numbers come through with all their digits.
        let script = format!("return (async () => JSON.stringify(await ({expression})))()");
        match self.command("/execute/sync", &json!({ "script": script, "args": [] })) {
            Value::String(text) => serde_json::from_str(&text).expect("JSON"),
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
            if start.elapsed().as_secs() >= PATIENCE_S {
                self.read_logs();
                panic!("never: {expression}; {:?}", self.trouble.borrow());
            }
            std::thread::sleep(Duration::from_millis(30));
        }
    }

    fn mouse(&self, kind: &str, x: f64, y: f64, pressed: bool) {
        let (button, clicks) = if pressed { ("left", 1) } else { ("none", 0) };
        let event = json!({ "type": kind, "x": x, "y": y, "button": button, "clickCount": clicks });
        self.devtools("Input.dispatchMouseEvent", &event);
    }

    /// Moves the mouse to a place of the window, CSS pixels.
    pub fn point_at(&self, x: f64, y: f64) {
        self.mouse("mouseMoved", x, y, false);
    }

    /// Clicks at a place of the window, CSS pixels.
    pub fn click_at(&self, x: f64, y: f64) {
        self.point_at(x, y);
        self.mouse("mousePressed", x, y, true);
        self.mouse("mouseReleased", x, y, true);
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

    /// Presses a key: a letter, or one of the keys below by its name.
    pub fn press(&self, key: &str) {
        // Code points of the WebDriver standard, section "keyboard actions".
        let value = match key {
            "Tab" => "\u{E004}",
            "Enter" => "\u{E007}",
            "Escape" => "\u{E00C}",
            "End" => "\u{E010}",
            "Home" => "\u{E011}",
            letter => letter,
        };
        assert_eq!(value.chars().count(), 1, "no name of a key: {key}");
        let strokes =
            [json!({ "type": "keyDown", "value": value }), json!({ "type": "keyUp", "value": value })];
        let keyboard = json!({ "type": "key", "id": "keyboard", "actions": strokes });
        self.command("/actions", &json!({ "actions": [keyboard] }));
    }

    /// What the browser has noted since the last call.
    fn read_logs(&self) {
        let log = |kind: &str| match self.command("/se/log", &json!({ "type": kind })) {
            Value::Array(entries) => entries,
            other => panic!("a log that is no list: {other}"),
        };
        let severe = log("browser").into_iter().filter(|entry| entry["level"] == "SEVERE");
        self.trouble.borrow_mut().extend(severe.map(|entry| entry["message"].to_string()));
        for entry in log("performance") {
            let text = entry["message"].as_str().expect("a message");
            let event: Value = serde_json::from_str(text).expect("JSON");
            if event["message"]["method"] == "Network.requestWillBeSent" {
                let url = event["message"]["params"]["request"]["url"].as_str().expect("an address");
                self.requests.borrow_mut().push(url.to_string());
            }
        }
    }

    /// Asserts that nothing went wrong so far, and that nothing but the file itself was asked for.
    pub fn assert_quiet(&self) {
        self.read_logs();
        let trouble = self.trouble.borrow();
        assert!(trouble.is_empty(), "{trouble:#?}");
        let requests = self.requests.borrow();
        let beyond: Vec<&String> =
            requests.iter().filter(|url| !url.starts_with("file://") && !url.starts_with("data:")).collect();
        let files = requests.iter().filter(|url| url.starts_with("file://")).count();
        assert!(beyond.is_empty() && files == 1, "{requests:?}");
    }
}

impl Drop for Page {
    fn drop(&mut self) {
        // Without it the browser outlives its driver.
        let address = format!("{}{}", self.driver.address, self.session);
        let _ = self.driver.agent.delete(address).call();
    }
}
