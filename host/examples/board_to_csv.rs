// SPDX-License-Identifier: MIT OR Apache-2.0
//! A board's bytes to CSV: `board_to_csv PROFILE CALIBRATION < /dev/ttyUSB1 > frames.csv`.

use hapticore_host::{COLUMNS, Decoder, DeviceCalibration, Message, Readout, SlotClock, profile};
use std::error::Error;
use std::io::{self, BufReader, Read, Write};

/// Converts until the bytes end; reports damaged packets on standard error.
pub fn convert(files: [&str; 2], bytes: impl Read, csv: impl Write) -> Result<(), Box<dyn Error>> {
    let device = DeviceCalibration::read(files[1].as_ref())?;
    let profile = device.profile(&profile::load(files[0])?)?;
    let (mut decoder, mut readout) = (Decoder::new(&profile), Readout::new(&profile, &device));
    let mut clock = SlotClock::new(&profile, device.device.sample_rate_hz, 0.0);
    let mut csv = csv::Writer::from_writer(csv);
    csv.write_record(COLUMNS)?;
    for byte in BufReader::new(bytes).bytes() {
        match decoder.push(byte?) {
            Some(Ok(Message::Frame(packet))) => {
                let time_s = clock.time_of(packet.status.sequence);
                csv.write_record(readout.row(time_s, &packet.frame.measurement(&profile)))?;
                csv.flush()?;
            }
            Some(Err(damage)) => eprintln!("{damage}"),
            Some(Ok(Message::Heartbeat(_))) | None => (),
        }
    }
    Ok(csv.flush()?)
}

#[allow(dead_code, reason = "tests include this file for `convert`")]
fn main() -> Result<(), Box<dyn Error>> {
    let files: Vec<String> = std::env::args().skip(1).collect();
    let [profile, calibration] = &files[..] else { return Err("expected two files".into()) };
    convert([profile, calibration], io::stdin().lock(), io::stdout().lock())
}
