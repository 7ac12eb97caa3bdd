// SPDX-License-Identifier: MIT OR Apache-2.0
//! What clients ask of the loop, between two slots. Another scene is set up in a second thread, while the source runs on.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::thread;

use super::{
    Client, ClientId, Driver, HANGS_S, Hub, Message, Opened, Reported, frames, panic_message,
};
use crate::client::{Bytes, text_frame};
use crate::pace::Pace;
use crate::protocol::{Answer, Command, Hello, Opening, Recording, Request};
use crate::rows::Subscriber;

impl Hub {
    pub(super) fn take(&mut self, message: Message) {
        match message {
            Message::Join(client, outbox) => {
                outbox.answer(self.hello());
                outbox.answer(frames(&*self.source));
                self.clients.insert(client, Client { outbox, subscriber: None });
            }
            Message::Leave(client) => {
                self.clients.remove(&client);
                if self.is_driver(client) {
                    self.take_drive_off();
                }
                if self.stepper == Some(client) {
                    self.stepper = None;
                    self.pace.set_stepped(false);
                }
            }
            Message::Request(client, request) => self.request(client, request),
            Message::Opened(opened) => self.opened(*opened),
        }
    }

    fn hello(&self) -> Bytes {
        let hello = Hello { speed: self.pace.speed(), ..self.source.hello() };
        text_frame(&Answer::Hello(Box::new(hello)).text())
    }

    fn request(&mut self, client: ClientId, Request { id, command }: Request) {
        self.hear(client);
        let outcome = match command {
            Command::Open(opening) => self.open(client, id, opening),
            Command::Record { to: Recording::Start } => self.open(client, id, self.opening.clone()),
            other => self.carry_out(client, other).map(|()| true),
        };
        match outcome {
            Ok(true) => self.answer(client, id, Ok(())),
            Ok(false) => (), // answered later
            Err(message) => self.answer(client, id, Err(message)),
        }
    }

    fn answer(&self, client: ClientId, id: Option<u64>, outcome: Result<(), String>) {
        let answer = match (outcome, id) {
            (Ok(()), Some(id)) => Answer::Done { id, slot: self.source.slot() },
            (Ok(()), None) => return,
            (Err(message), id) => Answer::Error { id, message },
        };
        self.send(client, &answer);
    }

    fn send(&self, client: ClientId, answer: &Answer) {
        if let Some(client) = self.clients.get(&client) {
            client.outbox.answer(text_frame(&answer.text()));
        }
    }

    fn carry_out(&mut self, client: ClientId, command: Command) -> Result<(), String> {
        if self.source.is_real() {
            self.check_real(client, &command)?;
        }
        match command {
            Command::Pace { speed } => {
                self.pace.set_speed(speed);
                self.stepper = None;
            }
            Command::Step { slots } => self.step(client, slots)?,
            Command::Alive => (),
            Command::Slot => self.send(client, &Answer::Slot(self.source.codes())),
            Command::Record { to } => {
                let recorded = self.source.record(to)?;
                self.send(client, &Answer::Recorded(recorded));
            }
            Command::Subscribe(asked) => {
                let subscriber = Subscriber::new(&asked)?;
                self.clients.entry(client).and_modify(|client| client.subscriber = subscriber);
            }
            input => match &self.stopped {
                Some(stopped) => return Err(stopped.clone()),
                None => {
                    self.source.apply(&input)?;
                    self.follow_driver(client, &input);
                }
            },
        }
        Ok(())
    }

    /// What clients of a board may not ask for. Anybody may take the drive to 0 V.
    fn check_real(&self, client: ClientId, command: &Command) -> Result<(), String> {
        let drives = matches!(
            command,
            Command::Arm { on: true }
                | Command::Target { .. }
                | Command::Set { .. }
                | Command::Wall { .. }
        );
        if matches!(command, Command::Pace { .. } | Command::Step { .. }) {
            return Err("expected a simulated source: a board's time goes on".into());
        }
        if drives && self.driver.is_some() && !self.is_driver(client) {
            return Err("another client has armed the drive: close that page first".into());
        }
        Ok(())
    }

    /// Who has armed the drive, after a command that was carried out.
    fn follow_driver(&mut self, client: ClientId, command: &Command) {
        match command {
            Command::Arm { on: true } => {
                self.driver = Some(Driver { client, heard_s: self.wall_s() });
            }
            Command::Arm { on: false } | Command::Disable => self.driver = None,
            _ => (),
        }
    }

    fn is_driver(&self, client: ClientId) -> bool {
        self.driver.as_ref().is_some_and(|driver| driver.client == client)
    }

    /// Whatever a client says is a sign of its life.
    fn hear(&mut self, client: ClientId) {
        let now_s = self.wall_s();
        if let Some(driver) = self.driver.as_mut().filter(|driver| driver.client == client) {
            driver.heard_s = now_s;
        }
    }

    /// Takes the drive to 0 V where the client that has armed it hangs, whose connection may stay open for minutes.
    pub(super) fn miss_driver(&mut self) {
        let now_s = self.wall_s();
        if self.driver.is_some() && self.source.line().is_some_and(|line| !line.armed) {
            // A fault has taken it off.
            self.driver = None;
        }
        if self.driver.as_ref().is_some_and(|driver| now_s - driver.heard_s > HANGS_S) {
            self.take_drive_off();
            let text = format!(
                "the page that armed the drive has sent no sign of life for {HANGS_S} s: the drive is off until it is armed \
                 again; a page in a hidden tab sends none"
            );
            self.tell_all(&Answer::Note { text });
        }
    }

    fn take_drive_off(&mut self) {
        self.driver = None;
        let _ = self.source.apply(&Command::Arm { on: false });
    }

    /// Runs slots at once, and lets time stand from then on. All of it is done before the next request.
    fn step(&mut self, client: ClientId, slots: usize) -> Result<(), String> {
        self.stepper = Some(client);
        self.pace.set_stepped(true);
        for _ in 0..slots {
            if self.stopped.is_some() || !self.run_slot() {
                return Err(self.stopped.clone().unwrap_or_default());
            }
        }
        let device_s = self.source.slot() as f64 * self.source.slot_s();
        self.pace.restart_at(device_s);
        self.send_frames(self.wall_s());
        Ok(())
    }

    /// Begins to set up another scene; false, since it is answered later.
    fn open(
        &mut self,
        client: ClientId,
        id: Option<u64>,
        opening: Opening,
    ) -> Result<bool, String> {
        if let Some(next) = &self.next {
            return Err(format!("open: {next} is being set up; ask again after its hello"));
        }
        let opening = self.setup.allowed(opening, &self.opening)?;
        self.next = Some(opening.scene.clone());
        let (setup, sender) = (self.setup.clone(), self.sender.clone());
        let spawned = thread::Builder::new().name("setup".into()).spawn(move || {
            let source = catch_unwind(AssertUnwindSafe(|| setup.source(&opening)));
            let source = source.unwrap_or_else(|panic| {
                Err(format!("{}: internal error: {}", opening.scene, panic_message(&*panic)))
            });
            let _ = sender.send(Message::Opened(Box::new(Opened { client, id, opening, source })));
        });
        if let Err(error) = spawned {
            self.next = None;
            return Err(format!("open: {error}"));
        }
        Ok(false)
    }

    fn opened(&mut self, Opened { client, id, opening, source }: Opened) {
        self.next = None;
        match source {
            Ok(source) => {
                (self.source, self.opening, self.stopped) = (source, opening, None);
                let now_s = self.wall_s();
                let stepped = self.pace.is_stepped();
                self.pace = Pace::new(now_s, self.pace.speed());
                self.pace.set_stepped(stepped);
                self.reported = Reported { wall_s: now_s, device_s: 0.0 };
                self.is_new = false;
                let hello = self.hello();
                self.clients.values().for_each(|client| client.outbox.answer(hello.clone()));
                self.answer(client, id, Ok(()));
            }
            Err(message) => self.answer(client, id, Err(message)),
        }
    }
}
