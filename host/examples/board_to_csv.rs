// SPDX-License-Identifier: MIT OR Apache-2.0
//! A board's bytes to CSV: `board_to_csv PROFILE CALIBRATION < /dev/ttyUSB1 > frames.csv`.

use hapticore_host::{COLUMNS, Decoder, DeviceCalibration, Message, Readout, SlotClock, profile};
use std::error::Error;
use std::io::{self, BufReader, Read, Write};

/// Converts until the bytes end; damaged packets are told on standard error.
pub fn convert(
    profile: &str,
    calibration: &str,
    bytes: impl Read,
    csv: impl Write,
) -> Result<(), Box<dyn Error>> {
    let device = DeviceCalibration::read(calibration.as_ref())?;
    let profile = device.profile(&profile::load(profile)?)?;
    let (mut decoder, mut readout) = (Decoder::new(&profile), Readout::new(&profile, &device));
    let mut clock = SlotClock::new(&profile, device.device.sample_rate_hz, 0.0);
    let mut csv = csv::Writer::from_writer(csv);
    csv.write_record(COLUMNS)?;
    for byte in BufReader::new(bytes).bytes() {
        match decoder.push(byte?) {
            Some(Ok(Message::Frame(packet))) => {
                let (measured, flags) = readout.convert(&packet.frame.measurement(&profile));
                let time_and_pad = [clock.time_of(packet.status.sequence), packet.frame.pad as f64];
                let numbers = time_and_pad
                    .into_iter()
                    .chain(measured.values())
                    .map(|number| number.to_string());
                csv.write_record(numbers.chain([flags]))?;
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
    let mut args = std::env::args().skip(1);
    let (Some(profile), Some(calibration)) = (args.next(), args.next()) else {
        return Err("expected PROFILE and CALIBRATION".into());
    };
    convert(&profile, &calibration, io::stdin().lock(), io::stdout().lock())
}
