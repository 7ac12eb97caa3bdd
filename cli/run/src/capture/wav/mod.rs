// SPDX-License-Identifier: MIT OR Apache-2.0
//! Captures as WAV: a channel each for the currents, the sensing voltage and the haptic voltage,
//! and perhaps one for the pad.
//!
//! As in any WAV file a sample's full scale is the ADC's. Codes of 18 bits are in the high bits of
//! samples of 24 bits, and the valid bits of WAVE_FORMAT_EXTENSIBLE in the high bits of their
//! container (Microsoft, "Extensible Wave-Format Descriptors"). Files beyond 4 GiB are RF64 (EBU
//! Tech 3306); BW64 (ITU-R BS.2088) is read, too.
//!
//! The reader is our own: it takes samples from a pipe, valid bits, and RF64, of which `hound`
//! takes none.

mod format;
pub mod read;
pub mod write;
