// SPDX-License-Identifier: MIT OR Apache-2.0
// Bench of the small profile's core: from the vectors' samples it must send the model's frames, and its other outputs must
// equal the model's at every clock. Reads calibration.csv, samples.csv, frames.csv and pins.csv (rtl/verilog/vectors) from the
// folder it runs in. For simulators without cocotb: Icarus, or Verilator with --binary --timing.

`timescale 1ns / 1ps
`default_nettype none

module bench;
    reg clock = 0, reset = 1, strobe = 0, clear = 0, write = 0;
    reg signed [15:0] code = 0, word = 0;
    reg [10:0] address = 0;
    reg [14:0] capacitance_gain = 0, force_gain = 0, contact_capacitance = 0;
    wire [2:0] channel, index;
    wire [1:0] serve, pad;
    wire signed [16:0] carrier;
    wire signed [15:0] frame;
    wire closed, valid, done, clipped, saturated, invalid, lost, lifted, overrun;

    hapticore_small core (
        .clock(clock), .reset(reset), .strobe(strobe), .clear(clear), .code(code),
        .capacitance_gain(capacitance_gain), .force_gain(force_gain), .contact_capacitance(contact_capacitance),
        .write(write), .address(address), .word(word), .channel(channel), .serve(serve), .closed(closed), .carrier(carrier),
        .valid(valid), .index(index), .frame(frame), .done(done), .pad(pad), .clipped(clipped), .saturated(saturated),
        .invalid(invalid), .lost(lost), .lifted(lifted), .overrun(overrun)
    );

    integer calibration, samples, frames, pins, found, matched, value, place, step, words, wrong, letter;
    // Clocks after reset, rows of samples; where the next row of pins.csv and of calibration.csv belongs.
    integer clocks, row, next_pins, next_row, period;
    integer codes [0:7];
    integer want [0:7];
    integer now [0:4];
    integer then [0:4];
    reg [8*64-1:0] name;
    // The core names the channel whose code it wants in the next clock.
    reg [2:0] asked = 0;

    task compare_frame;
        begin
            matched = $fscanf(frames, "%d,%d,%d,%d,%d,%d,%d,%d\n", want[0], want[1], want[2], want[3], want[4], want[5], want[6], want[7]);
            if (matched != 8 || pad !== want[0] || index !== want[1] || frame !== want[2] || clipped !== want[3] ||
                saturated !== want[4] || invalid !== want[5] || lost !== want[6] || lifted !== want[7]) begin
                $display("word %0d: pad %0d index %0d word %0d flags %b%b%b%b%b, expected %0d %0d %0d %0d%0d%0d%0d%0d", words, pad, index, frame, clipped,
                    saturated, invalid, lost, lifted, want[0], want[1], want[2], want[3], want[4], want[5], want[6], want[7]);
                wrong = wrong + 1;
            end
            words = words + 1;
        end
    endtask

    // Each row of pins.csv holds until the next.
    task compare_pins;
        begin
            if (clocks == next_pins) begin
                for (place = 0; place < 5; place = place + 1) now[place] = then[place];
                matched = $fscanf(pins, "%d,%d,%d,%d,%d,%d\n", next_pins, then[0], then[1], then[2], then[3], then[4]);
            end
            if (serve !== now[0] || closed !== now[1] || carrier !== now[2] || done !== now[3] || overrun !== now[4]) begin
                if (wrong < 100) $display("clock %0d: serve %0d closed %b carrier %0d done %b overrun %b, expected %0d %0d %0d %0d %0d",
                    clocks, serve, closed, carrier, done, overrun, now[0], now[1], now[2], now[3], now[4]);
                wrong = wrong + 1;
            end
        end
    endtask

    // A clock: inputs are there before its edge, outputs are looked at before it; a frame's, which are registers, behind it.
    task tick;
        begin
            #9 asked = channel;
            if (!reset) begin
                compare_pins;
                clocks = clocks + 1;
            end
            #1 clock = 1;
            #10 clock = 0;
            #1;
            if (valid) compare_frame;
        end
    endtask

    // What calibration.csv says before this row of samples.
    task calibrate;
        begin
            while (next_row == row) begin
                name = 0;
                place = 0;
                letter = $fgetc(calibration);
                while (letter != ",") begin
                    name = {name, letter[7:0]};
                    place = 10 * place + letter - "0";
                    letter = $fgetc(calibration);
                end
                found = $fscanf(calibration, "%d\n", value);
                case (name)
                    "capacitance_gain": capacitance_gain = value;
                    "force_gain": force_gain = value;
                    "contact_capacitance": contact_capacitance = value;
                    "clocks": period = value;
                    "clear": begin
                        clear = 1;
                        tick;
                        clear = 0;
                    end
                    default: begin
                        address = place;
                        write = 1;
                        word = value;
                        tick;
                        write = 0;
                    end
                endcase
                next_row = -1;
                found = $fscanf(calibration, "%d,", next_row);
            end
        end
    endtask

    // With +waves what the bench and all within it do is written into waves.vcd.
    initial if ($test$plusargs("waves")) begin
        $dumpfile("waves.vcd");
        $dumpvars(0, bench);
    end

    initial begin
        words = 0;
        wrong = 0;
        clocks = 0;
        row = 0;
        period = 24; // model/src/profile/small.toml
        calibration = $fopen("calibration.csv", "r");
        samples = $fopen("samples.csv", "r");
        frames = $fopen("frames.csv", "r");
        pins = $fopen("pins.csv", "r");
        found = $fgets(name, calibration);
        found = $fgets(name, samples);
        found = $fgets(name, frames);
        found = $fgets(name, pins);
        matched = $fscanf(pins, "%d,%d,%d,%d,%d,%d\n", next_pins, then[0], then[1], then[2], then[3], then[4]);
        found = $fscanf(calibration, "%d,", next_row);
        repeat (4) tick;
        reset = 0;
        found = 8;
        while (found == 8) begin
            calibrate;
            found = $fscanf(samples, "%d,%d,%d,%d,%d,%d,%d,%d\n", codes[0], codes[1], codes[2], codes[3], codes[4], codes[5],
                codes[6], codes[7]);
            row = row + 1;
            if (found == 8) for (step = 0; step < period; step = step + 1) begin
                strobe = step == 0;
                code = codes[asked];
                tick;
            end
        end
        repeat (10000) tick; // the last slot's estimate
        // Nothing is left over of what the model sent.
        matched = $fgetc(frames);
        if (words == 0 || wrong != 0 || matched >= 0) begin
            $display("FAILED: %0d words, %0d wrong", words, wrong);
            $fatal(1);
        end
        $display("PASSED: the frames are the model's, %0d words", words);
        $finish;
    end
endmodule

`default_nettype wire
