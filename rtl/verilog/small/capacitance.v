// capacitance: hapticore_model::blocks::capacitance::Capacitance
// Printed from the model by `hapticore hdl --profile small`; not to be edited.

`default_nettype none

module capacitance (
    input wire clock,
    input wire reset,
    input wire start, // u1.0  All others are there, and hold.
    input wire [15:0] total, // u16.13  The amplitude of the total current.
    input wire [15:0] sense, // u16.13  The amplitude of the sensing voltage.
    input wire [14:0] sheet, // u15.15  The sheet's resistance at the pad, in full scales of voltage per current.
    input wire [14:0] gain, // u15.5  Picofarads at an admittance of one.
    output reg done, // u1.0  Set for one clock when the capacitance is there.
    output reg [14:0] capacitance, // u15.5  The capacitance.
    output reg invalid, // u1.0  Whether there is no such capacitance.
    output reg saturated // u1.0  Whether a word is held at a rail.
);

    reg [3:0] step; // u4.0  0 idle, 1 load, 2 sense, 3 drop, 4 square, 5 drop_square, 6 radicand, 7 root, 8 divide, 9 gain_product, 10 finish
    reg [15:0] left; // u16.0
    reg [15:0] right; // u16.0
    reg [15:0] drop; // u16.13
    reg [31:0] square; // u32.26
    reg root_start; // u1.0
    reg divide; // u1.0
    wire [31:0] multiplier_product; // u32.0
    wire root_done; // u1.0
    wire [16:0] root_root; // u17.13
    wire divider_done; // u1.0
    wire [14:0] divider_quotient; // u15.14
    wire divider_saturated; // u1.0

    wire step_is_idle = step == 4'd0; // u1.0
    wire signed [32:0] left_over = {1'd0, square} - {1'd0, multiplier_product}; // s33.26
    wire [31:0] root_radicand = left_over[32] ? 32'd0 : left_over[31:0]; // u32.26
    wire step_is_root = step == 4'd7; // u1.0
    wire step_is_divide = step == 4'd8; // u1.0
    wire [30:0] fit_38 = multiplier_product[30:0]; // u31.0
    wire [16:0] fit_40 = {1'b0, fit_38[30:15]} + {16'd0, fit_38[14] & (fit_38[15] | (|fit_38[13:0]))}; // u17.13
    wire [29:0] fit_45 = multiplier_product[29:0]; // u30.0
    wire [16:0] fit_47 = {1'b0, fit_45[29:14]} + {16'd0, fit_45[13] & (fit_45[14] | (|fit_45[12:0]))}; // u17.5
    wire step_is_load = step == 4'd1; // u1.0
    wire step_is_sense = step == 4'd2; // u1.0
    wire step_is_square = step == 4'd4; // u1.0
    wire step_is_finish = step == 4'd10; // u1.0
    wire step_is_drop = step == 4'd3; // u1.0
    wire bit_83 = (step_is_drop & (~(fit_40[16] == 1'd0))) | ((step_is_divide & divider_done) & divider_saturated); // u1.0
    wire [4:0] choice_86 =
        ((step_is_root & (~root_done)) | (step_is_divide & (~divider_done))) ? {1'd0, step}
        : step_is_finish ? 5'd0
        : ({1'd0, step} + 5'd1); // u5.0

    multiplier u_multiplier (
        .clock(clock),
        .reset(reset),
        .enable(~step_is_idle),
        .left(left),
        .right(right),
        .product(multiplier_product)
    );

    root_2 u_root (
        .clock(clock),
        .reset(reset),
        .start(root_start),
        .radicand(root_radicand),
        .done(root_done),
        .root(root_root)
    );

    divider_2 u_divider (
        .clock(clock),
        .reset(reset),
        .start(divide),
        .numerator(total),
        .denominator(root_root),
        .done(divider_done),
        .quotient(divider_quotient),
        .saturated(divider_saturated)
    );

    always @(posedge clock) begin
        if (reset) begin
            step <= 4'd0;
            left <= 16'd0;
            right <= 16'd0;
            drop <= 16'd0;
            square <= 32'd0;
            root_start <= 1'd0;
            divide <= 1'd0;
            capacitance <= 15'd0;
            invalid <= 1'd0;
            saturated <= 1'd0;
            done <= 1'd0;
        end else begin
            if (start) begin
                step <= 4'd1;
                root_start <= 1'd0;
                divide <= 1'd0;
                saturated <= 1'd0;
                done <= 1'd0;
            end else if (step_is_idle) begin
                root_start <= 1'd0;
                divide <= 1'd0;
                done <= 1'd0;
            end else begin
                step <= choice_86[3:0];
                root_start <= step == 4'd5;
                divide <= step_is_root & root_done;
                saturated <= saturated | (bit_83 | (step_is_finish & (~(fit_47[16:15] == 2'd0))));
                done <= step_is_finish;
                if (step == 4'd6) begin
                    invalid <= root_radicand == 32'd0;
                end
                if (step_is_finish) begin
                    capacitance <= (|fit_47[16:15]) ? {15{1'b1}} : fit_47[14:0];
                end
                if (step_is_square) begin
                    square <= multiplier_product;
                end
                if (step_is_drop) begin
                    drop <= (|fit_40[16]) ? {16{1'b1}} : fit_40[15:0];
                end
                if (step_is_load) begin
                    left <= total;
                    right <= {1'd0, sheet};
                end else if (step_is_sense) begin
                    left <= sense;
                    right <= sense;
                end else if (step_is_square) begin
                    left <= drop;
                    right <= drop;
                end else begin
                    left <= {1'd0, divider_quotient};
                    right <= {1'd0, gain};
                end
            end
        end
    end

    // What nothing needs.
    wire unused = &{1'b0, choice_86[4]};

endmodule

`default_nettype wire
