// SPDX-License-Identifier: MIT OR Apache-2.0
// Models of the output cells of the boards' tops, which behave as the vendor's own: ODDRX1F outputs D0 in the first half of a
// clock and D1 in the second, three clocks after its inputs; SB_IO (here only with a DDR output) takes D_OUT_0 at the rising
// edge and D_OUT_1 at the falling edge. Pins change two nanoseconds later. (No continuous assignments with delays: Verilator
// evaluates them at every edge of the clock.)

`timescale 1ns / 1ps
`default_nettype none

module ODDRX1F (
    input wire D0,
    input wire D1,
    input wire SCLK,
    input wire RST,
    output wire Q
);
    reg [1:0] first, second, third;
    initial {first, second, third} = 6'h3f;
    always @(posedge SCLK) {first, second, third} <= RST ? 6'h00 : {D0, D1, first, second};
    wire half = SCLK ? third[1] : third[0];
    reg pin;
    initial pin = 1;
    always @(half) #2 pin = half;
    assign Q = pin;
endmodule

module SB_IO #(
    parameter [5:0] PIN_TYPE = 6'b0100_00
) (
    output wire PACKAGE_PIN,
    input wire OUTPUT_CLK,
    input wire D_OUT_0,
    input wire D_OUT_1
);
    reg rise, fall;
    initial {rise, fall} = 2'b11;
    always @(posedge OUTPUT_CLK) rise <= D_OUT_0;
    always @(negedge OUTPUT_CLK) fall <= D_OUT_1;
    wire half = OUTPUT_CLK ? rise : fall;
    reg pin;
    initial pin = 1;
    always @(half) #2 pin = half;
    assign PACKAGE_PIN = pin;
    initial if (PIN_TYPE != 6'b0100_00) $display("SB_IO: only a DDR output is modelled");
endmodule

`default_nettype wire
