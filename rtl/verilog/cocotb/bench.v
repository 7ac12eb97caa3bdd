// SPDX-License-Identifier: MIT OR Apache-2.0
// The core of the small profile with slots of samples: it must send the frames that the model sent. Reads calibration.csv,
// samples.csv and frames.csv (rtl/verilog/vectors) from the folder it runs in. For simulators without cocotb.

`timescale 1ns / 1ps
`default_nettype none

module bench;
    reg clock = 0, reset = 1, strobe = 0, write = 0;
    reg signed [15:0] code = 0, word = 0;
    reg [10:0] address = 0;
    reg [14:0] capacitance_gain = 0, force_gain = 0;
    wire [2:0] channel, index;
    wire [1:0] pad;
    wire signed [17:0] frame;
    wire valid, clipped, saturated, invalid, lost, overrun;

    hapticore core (
        .clock(clock), .reset(reset), .strobe(strobe), .clear(1'b0), .code(code),
        .capacitance_gain(capacitance_gain), .force_gain(force_gain),
        .write(write), .address(address), .word(word), .channel(channel), .serve(), .closed(), .carrier(),
        .valid(valid), .index(index), .frame(frame), .done(), .pad(pad), .clipped(clipped), .saturated(saturated),
        .invalid(invalid), .lost(lost), .overrun(overrun)
    );

    integer file, frames, found, matched, value, step, words, wrong, letter;
    integer codes [0:7];
    integer want [0:6];
    reg [8*64-1:0] name;
    // The core names the channel whose code it wants in the next clock.
    reg [2:0] asked = 0;

    // A clock: inputs are there before its edge, outputs are looked at before the next.
    task tick;
        begin
            #9 asked = channel;
            #1 clock = 1;
            #10 clock = 0;
            #1;
            if (valid) begin
                matched = $fscanf(frames, "%d,%d,%d,%d,%d,%d,%d\n", want[0], want[1], want[2], want[3], want[4], want[5], want[6]);
                if (matched != 7 || pad != want[0] || index != want[1] || frame != want[2] || clipped != want[3] ||
                    saturated != want[4] || invalid != want[5] || lost != want[6]) begin
                    $display("word %0d: pad %0d index %0d word %0d flags %b%b%b%b, expected %0d %0d %0d %0d%0d%0d%0d", words, pad,
                        index, frame, clipped, saturated, invalid, lost, want[0], want[1], want[2], want[3], want[4], want[5], want[6]);
                    wrong = wrong + 1;
                end
                words = words + 1;
            end
        end
    endtask

    initial begin
        words = 0;
        wrong = 0;
        frames = $fopen("frames.csv", "r");
        found = $fgets(name, frames);
        repeat (4) tick;
        reset = 0;
        file = $fopen("calibration.csv", "r");
        found = $fgets(name, file);
        letter = $fgetc(file);
        while (letter > 0) begin
            name = 0;
            while (letter > 0 && letter != ",") begin
                name = {name, letter[7:0]};
                letter = $fgetc(file);
            end
            found = $fscanf(file, "%d\n", value);
            case (name)
                "capacitance_gain": capacitance_gain = value;
                "force_gain": force_gain = value;
                default: begin
                    found = $sscanf(name, "%d", address);
                    write = 1;
                    word = value;
                    tick;
                    write = 0;
                end
            endcase
            letter = $fgetc(file);
        end
        file = $fopen("samples.csv", "r");
        found = $fgets(name, file);
        found = 8;
        while (found == 8) begin
            found = $fscanf(file, "%d,%d,%d,%d,%d,%d,%d,%d\n", codes[0], codes[1], codes[2], codes[3], codes[4], codes[5],
                codes[6], codes[7]);
            if (found == 8) for (step = 0; step < 24; step = step + 1) begin
                strobe = step == 0;
                code = codes[asked];
                tick;
            end
        end
        repeat (6000) tick;
        if (words != 128 || wrong != 0) begin
            $display("FAILED: %0d words, %0d wrong", words, wrong);
            $fatal(1);
        end
        $display("PASSED: the frames are the model's, %0d words", words);
        $finish;
    end
endmodule

`default_nettype wire
