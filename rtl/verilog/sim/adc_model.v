// SPDX-License-Identifier: MIT OR Apache-2.0
// An AD7606C-class ADC at its serial pins, for tests: eight channels sampled at the rising edge of CONVST, the codes taken
// from a file, eight a sample. Delays in nanoseconds; between the end of its hold time and its access time a data line is
// unknown, so that a bit captured at the wrong moment is seen. What the data sheet forbids counts in `faults`.
//
// After reset one data line is in use; writing 18 (hex) into register 2 makes it eight (DOUT_FORMAT), and while
// registers are being written, up to a write into register 0, no codes come out.

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
    parameter real T_PULSE = 6.0      // the shortest low pulse of SCLK
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
    reg eight_lines, writing, ready;
    integer sample, taken, falls, bits, line, faults;
    realtime fell;

    initial begin
        $readmemh(FILE, codes);
        busy = 0;
        dout = 8'hxx;
        sample = 0;
        faults = 0;
        eight_lines = 0;
        writing = 0;
        ready = 0;
        bits = 0;
        falls = 0;
        fell = 0;
    end

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
                dout[line] = (writing || (line > 0 && !eight_lines) || bits >= BITS) ? 1'bx : shown[line][BITS-1-bits];
        end
    endtask

    always @(posedge reset) begin
        eight_lines = 0;
        writing = 0;
    end

    // Before its first reset nothing is asked of anybody.
    always @(negedge reset) if ($realtime > 0) ready = 1;

    always @(posedge convst) if (!reset) begin
        if (busy) fault(1);
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
        bits = 0;
        falls = 0;
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

    always @(posedge cs_n) if (!reset) begin
        dout = 8'hxx;
        if (falls == 16 && command[15:14] == 2'b00 && (writing || command[13:0] != 0)) begin
            if (command[13:8] == 6'h02) eight_lines = command[4:3] == 2'b11;
            writing = command[13:8] != 0;
        end
    end

endmodule

`default_nettype wire
