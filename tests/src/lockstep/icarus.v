// SPDX-License-Identifier: MIT OR Apache-2.0
// Runs @TOP@ on the inputs of a trace and compares every output at every clock.
`timescale 1ns / 1ns

module bench;
    reg clock = 0;
    reg reset = 1;
    integer file, got, clocks, more;
@DECLARE@
    @TOP@ dut (
        .clock(clock), .reset(reset)
@CONNECT@    );

    task read;
        begin
@READ@            more = got == 1;
        end
    endtask

    task compare;
        begin
@COMPARE@        end
    endtask

    initial begin
        file = $fopen("trace.hex", "r");
        clocks = 0;
        read;
        repeat (2) begin
            #1 clock = 1;
            #1 clock = 0;
        end
        reset = 0;
        while (more) begin
            #1 compare;
            clock = 1;
            #1 clock = 0;
            clocks = clocks + 1;
            read;
        end
        $display("equal %0d", clocks);
        $finish(0);
    end
endmodule
