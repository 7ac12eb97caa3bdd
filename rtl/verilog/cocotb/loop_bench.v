// SPDX-License-Identifier: MIT OR Apache-2.0
// Bench of a printed force loop: written its words and given samples, it must give the expected drive words and frames.
//
//   codes.csv    name,address,code,…       words before the first sample: what `hapticore codes --format csv` prints
//   events.csv   sample,name,address,code  words before a row of samples (0: the first); besides those of codes.csv
//                enable, clear_faults, alive, tick, drives_clear, clear and clear_and_strobe, and clocks: from one strobe to the
//                next. A millisecond passes with each tick: without one nothing is driven
//   samples.csv  one code per channel      a row per strobe: terminals, sensing voltage, haptic voltage; further columns are ignored
//   drives.csv   pad,drive,low,high,silence,sensor,force   a row per drive word, expected; may be missing
//   frames.csv   pad,index,word,clipped,saturated,invalid,lost,lifted   a row per word of a frame, expected; may be missing
//   pins.csv     clock,serve,closed,carrier,overrun   a row per clock after reset at which one of them changes, expected; may be missing
//
// Reads them from the folder it runs in and writes got.csv, in the columns of drives.csv. Compile with the folder of the printed
// loop on the include path (hapticore.vh), its top module as LOOP, and WALLS where its profile has walls:
//   iverilog -g2005 -I loop -DLOOP=hapticore_loop_loop -DWALLS -s bench loop/*.v cocotb/loop_bench.v

`timescale 1ns / 1ps
`default_nettype none

module bench;
    `include "hapticore.vh"

    reg clock = 0, reset = 1, strobe = 0, clear = 0, write = 0, target_write = 0, alive = 0, clear_faults = 0, enable = 0,
        curve_write = 0, tick_ms = 0, drives_clear = 0;
    reg signed [HAPTICORE_CODE_BITS-1:0] code = 0;
    reg [HAPTICORE_CAPACITANCE_GAIN_BITS-1:0] capacitance_gain = 0;
    reg [HAPTICORE_FORCE_GAIN_BITS-1:0] force_gain = 0;
    reg [HAPTICORE_CONTACT_CAPACITANCE_BITS-1:0] contact_capacitance = 0;
    reg [HAPTICORE_ADDRESS_BITS-1:0] address = 0;
    reg signed [HAPTICORE_WORD_BITS-1:0] word = 0;
    reg [HAPTICORE_TARGET_PAD_BITS-1:0] target_pad = 0;
    reg [HAPTICORE_TARGET_WORD_BITS-1:0] target_word = 0;
    reg [HAPTICORE_FULL_DRIVE_BITS-1:0] full_drive = 0;
    reg [HAPTICORE_PROPORTIONAL_BITS-1:0] proportional = 0;
    reg [HAPTICORE_CORRECTION_BITS-1:0] correction = 0;
    reg [HAPTICORE_RAIL_BITS-1:0] rail = 0;
    reg [HAPTICORE_SLEW_BITS-1:0] slew = 0;
    reg [HAPTICORE_FORCE_CAP_BITS-1:0] force_cap = 0;
    reg [HAPTICORE_CURVE_ADDRESS_BITS-1:0] curve_address = 0;
    reg [HAPTICORE_CURVE_WORD_BITS-1:0] curve_word = 0;
    wire [HAPTICORE_CHANNEL_BITS-1:0] channel;
    wire [HAPTICORE_INDEX_BITS-1:0] index;
    wire [HAPTICORE_PAD_BITS-1:0] pad;
    wire [HAPTICORE_DRIVE_PAD_BITS-1:0] drive_pad;
    wire [HAPTICORE_DRIVE_BITS-1:0] drive;
    wire signed [HAPTICORE_FRAME_BITS-1:0] frame;
    wire [HAPTICORE_PAD_BITS-1:0] serve;
    wire closed, overrun;
    wire signed [HAPTICORE_CARRIER_BITS-1:0] carrier;
    wire valid, clipped, saturated, invalid, lost, lifted, drive_valid, drive_low, drive_high, silence_fault, sensor_fault, force_fault;
`ifdef WALLS
    reg wall_write = 0, wall_right = 0;
    reg [HAPTICORE_WALL_PAD_BITS-1:0] wall_pad = 0;
    reg signed [HAPTICORE_WALL_SURFACE_BITS-1:0] wall_surface = 0;
    reg [HAPTICORE_WALL_STIFFNESS_BITS-1:0] wall_stiffness = 0;
    reg [HAPTICORE_WALL_MOST_BITS-1:0] wall_most = 0;
    reg signed [HAPTICORE_WALL_FACTORY_BITS-1:0] wall_factory = 0;
`endif

    `LOOP force_loop (
        .clock(clock), .reset(reset), .strobe(strobe), .clear(clear), .code(code), .capacitance_gain(capacitance_gain),
        .force_gain(force_gain), .contact_capacitance(contact_capacitance), .write(write), .address(address), .word(word), .target_write(target_write),
        .target_pad(target_pad), .target_word(target_word), .alive(alive), .clear_faults(clear_faults), .enable(enable),
        .full_drive(full_drive), .proportional(proportional), .correction(correction), .rail(rail), .slew(slew),
        .force_cap(force_cap), .curve_write(curve_write), .curve_address(curve_address), .curve_word(curve_word),
`ifdef WALLS
        .wall_write(wall_write), .wall_pad(wall_pad), .wall_surface(wall_surface), .wall_right(wall_right),
        .wall_stiffness(wall_stiffness), .wall_most(wall_most), .wall_factory(wall_factory), .wall_restart(1'b0),
`endif
        .drives_clear(drives_clear), .tick(tick_ms), .extremes_read(1'b0), .channel(channel), .serve(serve), .closed(closed), .carrier(carrier), .overrun(overrun),
        .valid(valid), .index(index), .frame(frame), .pad(pad), .clipped(clipped),
        .saturated(saturated), .invalid(invalid), .lost(lost), .lifted(lifted), .drive_valid(drive_valid), .drive_pad(drive_pad), .drive(drive),
        .drive_low(drive_low), .drive_high(drive_high), .silence_fault(silence_fault), .sensor_fault(sensor_fault),
        .force_fault(force_fault)
    );

    integer codes, events, samples, drives, frames, pins, got;
    integer found, letter, place, value, more, next_row, row, period, step, driven, words, wrong;
    integer set [0:HAPTICORE_CHANNELS-1];
    integer want [0:7];
    integer now [0:3];
    integer then [0:3];
    integer clocks, next_pins;
    reg [8*32-1:0] name;
    // The core names the channel whose code it wants in the next clock.
    reg [HAPTICORE_CHANNEL_BITS-1:0] asked = 0;

    task compare_drive;
        begin
            $fdisplay(got, "%0d,%0d,%0d,%0d,%0d,%0d,%0d", drive_pad, drive, drive_low, drive_high, silence_fault, sensor_fault,
                force_fault);
            driven = driven + 1;
            if (drives != 0) match_drive;
        end
    endtask

    task match_drive;
        begin
            found = $fscanf(drives, "%d,%d,%d,%d,%d,%d,%d\n", want[0], want[1], want[2], want[3], want[4], want[5], want[6]);
            if (found != 7 || drive_pad !== want[0] || drive !== want[1] || drive_low !== want[2] || drive_high !== want[3] ||
                silence_fault !== want[4] || sensor_fault !== want[5] || force_fault !== want[6]) begin
                if (wrong < 100) $display("drive word %0d: got %0d,%0d,%0d,%0d,%0d,%0d,%0d, expected %0d,%0d,%0d,%0d,%0d,%0d,%0d", driven,
                    drive_pad, drive, drive_low, drive_high, silence_fault, sensor_fault, force_fault, want[0], want[1], want[2],
                    want[3], want[4], want[5], want[6]);
                wrong = wrong + 1;
            end
        end
    endtask

    task compare_frame;
        begin
            found = $fscanf(frames, "%d,%d,%d,%d,%d,%d,%d,%d\n", want[0], want[1], want[2], want[3], want[4], want[5], want[6],
                want[7]);
            if (found != 8 || pad !== want[0] || index !== want[1] || frame !== want[2] || clipped !== want[3] ||
                saturated !== want[4] || invalid !== want[5] || lost !== want[6] || lifted !== want[7]) begin
                if (wrong < 100) $display("word %0d: got %0d,%0d,%0d, expected %0d,%0d,%0d", words, pad, index, frame, want[0], want[1],
                    want[2]);
                wrong = wrong + 1;
            end
            words = words + 1;
        end
    endtask

    // Each row of pins.csv holds until the next.
    task compare_pins;
        begin
            if (clocks == next_pins) begin
                for (found = 0; found < 4; found = found + 1) now[found] = then[found];
                found = $fscanf(pins, "%d,%d,%d,%d,%d\n", next_pins, then[0], then[1], then[2], then[3]);
            end
            if (serve !== now[0] || closed !== now[1] || carrier !== now[2] || overrun !== now[3]) begin
                if (wrong < 100) $display("clock %0d: serve %0d closed %b carrier %0d overrun %b, expected %0d %0d %0d %0d", clocks,
                    serve, closed, carrier, overrun, now[0], now[1], now[2], now[3]);
                wrong = wrong + 1;
            end
            clocks = clocks + 1;
        end
    endtask

    // A clock: inputs are there before its edge, and pins are compared before it; outputs that are registers, behind it.
    task tick;
        begin
            #9 asked = channel;
            if (!reset && pins != 0) compare_pins;
            #1 clock = 1;
            #10 clock = 0;
            #1;
            if (drive_valid) compare_drive;
            if (valid && frames != 0) compare_frame;
        end
    endtask

    task skip_line(input integer file);
        begin
            letter = $fgetc(file);
            while (letter >= 0 && letter != "\n") letter = $fgetc(file);
        end
    endtask

    // A row: name,address,code and what else stands there. Comments are skipped.
    task read_word(input integer file);
        begin
            name = 0;
            place = 0;
            letter = $fgetc(file);
            while (letter == "#") begin
                skip_line(file);
                letter = $fgetc(file);
            end
            more = letter >= 0;
            while (letter >= 0 && letter != ",") begin
                name = {name, letter[7:0]};
                letter = $fgetc(file);
            end
            letter = more ? $fgetc(file) : -1;
            while (letter >= 0 && letter != ",") begin
                place = 10 * place + letter - "0";
                letter = $fgetc(file);
            end
            if (more) begin
                found = $fscanf(file, "%d", value);
                skip_line(file);
            end
        end
    endtask

    task apply;
        case (name)
            "name": ; // the head of the table
            "capacitance_gain": capacitance_gain = value;
            "force_gain": force_gain = value;
            "contact_capacitance": contact_capacitance = value;
            "position_table": begin
                address = place; word = value; write = 1; tick; write = 0;
            end
            "full_drive": full_drive = value;
            "proportional": proportional = value;
            "correction": correction = value;
            "rail": rail = value;
            "slew": slew = value;
            "force_cap": force_cap = value;
            "curve_word": begin
                curve_address = place; curve_word = value; curve_write = 1; tick; curve_write = 0;
            end
            "target_word": begin
                target_pad = place; target_word = value; target_write = 1; tick; target_write = 0;
            end
`ifdef WALLS
            "wall_stiffness": wall_stiffness = value;
            "wall_most": wall_most = value;
            "wall_factory": wall_factory = value;
            "wall_right": wall_right = value;
            "wall_surface": begin
                wall_pad = place; wall_surface = value; wall_write = 1; tick; wall_write = 0;
            end
`endif
            "enable": enable = value;
            "clear_faults": begin clear_faults = 1; tick; clear_faults = 0; end
            "alive": begin alive = 1; tick; alive = 0; end
            "tick": begin tick_ms = 1; tick; tick_ms = 0; end
            "drives_clear": begin drives_clear = 1; tick; drives_clear = 0; end
            "clear": begin clear = 1; tick; clear = 0; end
            "clear_and_strobe": begin clear = 1; strobe = 1; tick; clear = 0; strobe = 0; end
            "clocks": period = value;
            default: begin
                $display("unknown word %0s", name);
                wrong = wrong + 1;
            end
        endcase
    endtask

    // A row of codes and what else stands there. In Verilator 5.006 a format that ends with a comma leaves it in the file.
    task read_samples;
        begin
            more = 1;
            for (step = 0; step < HAPTICORE_CHANNELS && more; step = step + 1) begin
                more = $fscanf(samples, "%d", value) == 1;
                set[step] = value;
                letter = $fgetc(samples); // behind the code
            end
            if (more && letter != "\n") skip_line(samples);
            if (!more && step > 1) begin
                $display("samples.csv: row %0d is cut: expected %0d codes, got %0d", row, HAPTICORE_CHANNELS, step - 1);
                wrong = wrong + 1;
            end
        end
    endtask

    // Comments, and the head of the table.
    task skip_head(input integer file);
        begin
            letter = $fgetc(file);
            while (letter == "#") begin
                skip_line(file);
                letter = $fgetc(file);
            end
            skip_line(file);
        end
    endtask

    // With +waves what the bench and all within it do is written into waves.vcd.
    initial if ($test$plusargs("waves")) begin
        $dumpfile("waves.vcd");
        $dumpvars(0, bench);
    end

    initial begin
        driven = 0;
        words = 0;
        wrong = 0;
        row = 0;
        period = HAPTICORE_CLOCKS_PER_SAMPLE;
        codes = $fopen("codes.csv", "r");
        events = $fopen("events.csv", "r");
        samples = $fopen("samples.csv", "r");
        drives = $fopen("drives.csv", "r");
        frames = $fopen("frames.csv", "r");
        pins = $fopen("pins.csv", "r");
        got = $fopen("got.csv", "w");
        $fdisplay(got, "pad,drive,low,high,silence,sensor,force");
        skip_head(samples);
        skip_line(events);
        if (drives != 0) skip_line(drives);
        if (frames != 0) skip_line(frames);
        clocks = 0;
        next_pins = -1;
        if (pins != 0) begin
            skip_line(pins);
            found = $fscanf(pins, "%d,%d,%d,%d,%d\n", next_pins, then[0], then[1], then[2], then[3]);
        end
        repeat (4) tick;
        reset = 0;
        read_word(codes);
        while (more) begin
            apply;
            read_word(codes);
        end
        next_row = -1;
        found = $fscanf(events, "%d,", next_row);
        read_samples;
        while (more) begin
            while (next_row == row) begin
                read_word(events);
                apply;
                next_row = -1;
                found = $fscanf(events, "%d,", next_row);
            end
            for (step = 0; step < period; step = step + 1) begin
                strobe = step == 0;
                code = set[asked];
                tick;
            end
            strobe = 0;
            row = row + 1;
            read_samples;
        end
        repeat (HAPTICORE_LATENCY + 100) tick; // the last slot's estimate
        // Nothing is left over of what the model gave.
        letter = -1;
        if (drives != 0) letter = $fgetc(drives);
        if (frames != 0 && letter < 0) letter = $fgetc(frames);
        if (driven == 0 || wrong != 0 || letter >= 0) begin
            $display("FAILED: %0d drive words, %0d words of frames, %0d wrong", driven, words, wrong);
            $fatal(1);
        end
        $display("PASSED: %0d drive words, %0d words of frames", driven, words);
        $finish;
    end
endmodule

`default_nettype wire
