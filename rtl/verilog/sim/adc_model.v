// SPDX-License-Identifier: MIT OR Apache-2.0
// Model of an AD7606C-class ADC at its serial pins, for tests: eight channels are sampled at the rising edge of CONVST, with
// codes from a file, eight per sample. Delays are in nanoseconds. Between hold time and access time a data line is unknown, so
// that a bit captured at the wrong moment is detected. Violations of the data sheet are counted in `faults`.
//
// After a reset two data lines are in use; 18 (hex) in register 2 selects eight (DOUT_FORMAT). A read of a register enters
// register mode, in which no codes are output; a write to address 0 ends it. Outside of it a write is refused. The register
// that was read is output on the first line during the next word. SDI may change while CS is low only for such words; they
// are counted in `commands`.

`timescale 1ns / 1ps
`default_nettype none

module adc_model #(
    parameter BITS = 16,
    parameter SAMPLES = 1,
    parameter FILE = "codes.hex",
    parameter real T_CONVERT = 550.0, // CONVST to the fall of BUSY
    parameter real T_BUSY = 25.0,     // CONVST to the rise of BUSY
    parameter real T_CS = 12.0,       // CS to the first bit
    parameter real T_HOLD = 5.0,      // rising edge of SCLK to the end of the bit before
    parameter real T_ACCESS = 15.0,   // rising edge of SCLK to the next bit
    parameter real T_PULSE = 6.0,     // the shortest low pulse of SCLK
    parameter real T_RESET = 3200.0,  // the shortest reset
    parameter real T_SETUP = 253000.0, // the end of a reset to the first word or conversion
    parameter [7:0] ID = 8'h31
) (
    input wire reset,
    input wire convst,
    input wire cs_n,
    input wire sclk,
    input wire sdi,
    output reg busy,
    output reg [7:0] dout
);

    reg [BITS-1:0] codes [0:8*SAMPLES-1];
    reg [BITS-1:0] shown [0:7];
    reg [15:0] command;
    reg [7:0] registers [0:63];
    reg [15:0] answer;
    reg register_mode, ready, moved;
    integer sample, taken, falls, bits, line, lines, faults, commands, k;
    realtime fell, reset_at, released, selected;

    initial begin
        $readmemh(FILE, codes);
        busy = 0;
        dout = 8'h00;
        for (k = 0; k < 8; k = k + 1) shown[k] = 0;
        sample = 0;
        faults = 0;
        commands = 0;
        ready = 0;
        bits = 0;
        falls = 0;
        fell = 0;
        reset_at = 0;
        released = 0;
        selected = 0;
        defaults;
    end

    task defaults;
        begin
            for (k = 0; k < 64; k = k + 1) registers[k] = 0;
            registers[2] = 8'h08;
            for (k = 3; k < 7; k = k + 1) registers[k] = 8'h33;
            registers[6'h2f] = ID;
            register_mode = 0;
            answer = 16'h0000;
            moved = 0;
            lines = 2;
        end
    endtask

    task fault(input integer what);
        if (ready) begin
            faults = faults + 1;
            $display("adc_model: fault %0d at %0t", what, $realtime);
        end
    endtask

    // The lines show the bit of this number, the most significant being 0.
    task show;
        begin
            for (line = 0; line < 8; line = line + 1)
                dout[line] = (bits >= BITS || register_mode) ? 1'b0 : line >= lines ? 1'bx : shown[line][BITS-1-bits];
            if (register_mode && bits < 16) dout[0] = answer[15-bits];
        end
    endtask

    always @(posedge reset) begin
        defaults;
        reset_at = $realtime;
    end

    // Before its first reset nothing is asked of anybody.
    always @(negedge reset) if ($realtime > 0) begin
        if ($realtime - reset_at < T_RESET) fault(6);
        released = $realtime;
        ready = 1;
    end

    // A word that came over SDI: sixteen bits, or another number of them.
    task word;
        if (register_mode || command != 0) begin
            commands = commands + 1;
            answer = 16'h0000;
            if (falls != 16 || command[15]) fault(7);
            else if (command[14]) begin
                register_mode = 1;
                if (command[13:8] == 0 || command[13:8] > 6'h2f) fault(8);
                answer = {8'h00, registers[command[13:8]]};
            end else if (!register_mode) fault(9); // a write without a read before it
            else if (command[13:8] == 0) begin
                register_mode = 0;
                if (command[7:0] != 0) fault(10);
            end else begin
                case (command[13:8])
                    6'h02: if (command[7] || command[2]) fault(11);
                    6'h03, 6'h04, 6'h05, 6'h06: if (command[3:0] > 11 || command[7:4] > 11) fault(11);
                    6'h07: ;
                    default: fault(12); // nothing that a board has to write
                endcase
                registers[command[13:8]] = command[7:0];
                lines = 1 << registers[2][4:3];
            end
        end
    endtask

    // A change with CS's own edge is none.
    always @(sdi) if (cs_n === 1'b0 && $realtime > selected) moved = 1;

    always @(posedge convst) if (!reset) begin
        if (busy) fault(1);
        if (register_mode) fault(13);
        if ($realtime - released < T_SETUP) fault(14);
        taken = sample;
        sample = sample + 1;
        #(T_BUSY) busy = 1;
        #(T_CONVERT - T_BUSY);
        if (!cs_n) fault(2); // the codes being read would be replaced
        for (line = 0; line < 8; line = line + 1)
            shown[line] = taken < SAMPLES ? codes[8 * taken + line] : {BITS{1'b0}};
        busy = 0;
    end

    always @(negedge cs_n) begin
        if (sclk !== 1'b1) fault(3); // SCLK rests high
        if ($realtime - released < T_SETUP) fault(14);
        bits = 0;
        falls = 0;
        command = 0;
        moved = 0;
        selected = $realtime + 1;
        #(T_CS) show;
    end

    always @(posedge sclk) if (!cs_n) begin
        if ($realtime - fell < T_PULSE) fault(4);
        #(T_HOLD) dout = 8'hxx;
        bits = bits + 1;
        #(T_ACCESS - T_HOLD) show;
    end

    always @(negedge sclk) begin
        fell = $realtime;
        if (cs_n !== 1'b0) fault(5);
        command = {command[14:0], sdi};
        falls = falls + 1;
    end

    // Lines that are not driven are pulled low: a pin always reads as something.
    always @(posedge cs_n) if (!reset) begin
        dout = 8'h00;
        // A word of one bit only, over and over, is none: SDI rests.
        if (moved && !register_mode && command == 0) fault(15);
        word;
    end

endmodule

`default_nettype wire
