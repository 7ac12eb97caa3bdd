// SPDX-License-Identifier: MIT OR Apache-2.0
// Board: while the ADC is being selected, SDI rests, but for the words that are meant for it. Of the ADC reader the proof takes
// what its own claims (`shift` changes with CS alone), of all other blocks nothing: they may do anything.
//
// Appended to the printed module.

    reg was_reset = 0, low_before = 0, shift_before = 0, sdi_before = 0;
    always @(posedge clock) begin
        was_reset <= 1;
        low_before <= !reset && !cs_n;
        shift_before <= adc_reader_shift;
        sdi_before <= sdi;
    end
    always @(*) if (was_reset) begin
        assume (!adc_reader_shift || !adc_reader_cs_n);
        if (low_before && !adc_reader_cs_n) assume (adc_reader_shift == shift_before);
    end

    always @(posedge clock) if (was_reset) begin
        if (!adc_reader_shift) assert (!sdi);
        if (low_before && !cs_n && !adc_reader_shift) assert (sdi == sdi_before);
        cover (low_before && !cs_n && !adc_reader_shift && registers_sdi);
        cover (low_before && !cs_n && sdi && !sdi_before);
    end
