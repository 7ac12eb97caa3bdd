// capacitance: hapticore_model::blocks::capacitance::Capacitance
// Printed from the model by `hapticore hdl --profile standard`; not to be edited.

`default_nettype none

module capacitance (
    input wire clock,
    input wire reset,
    input wire start, // u1.0  All others are there, and hold.
    input wire [26:0] total, // u27.23  The amplitude of the total current.
    input wire [26:0] sense, // u27.23  The amplitude of the sensing voltage.
    input wire [16:0] sheet, // u17.17  The sheet's resistance at the pad, in full scales of voltage per current.
    input wire [17:0] gain, // u18.7  Picofarads at an admittance of one.
    output reg done, // u1.0  Set for one clock when the capacitance is there.
    output reg [23:0] capacitance, // u24.13  The capacitance.
    output reg invalid, // u1.0  Whether there is no such capacitance.
    output reg saturated // u1.0  Whether a word is held at a rail.
);

    reg [3:0] step; // u4.0  0 idle, 1 load, 2 sense, 3 drop, 4 square, 5 drop_square, 6 radicand, 7 root, 8 divide, 9 gain_product, 10 finish
    reg waited; // u1.0
    reg [26:0] left; // u27.0
    reg [26:0] right; // u27.0
    reg [26:0] drop; // u27.23
    reg [53:0] square; // u54.46
    reg root_start; // u1.0
    reg divide; // u1.0
    wire [53:0] multiplier_product; // u54.0
    wire root_done; // u1.0
    wire [27:0] root_root; // u28.23
    wire divider_done; // u1.0
    wire [23:0] divider_quotient; // u24.22
    wire divider_saturated; // u1.0

    wire step_is_idle = step == 4'd0; // u1.0
    wire signed [54:0] left_over = {1'd0, square} - {1'd0, multiplier_product}; // s55.46
    wire [53:0] root_radicand = left_over[54] ? 54'd0 : left_over[53:0]; // u54.46
    wire step_is_root = step == 4'd7; // u1.0
    wire step_is_divide = step == 4'd8; // u1.0
    wire bit_39 = (waited | step_is_root) | step_is_divide; // u1.0
    wire [43:0] fit_40 = multiplier_product[43:0]; // u44.0
    wire [27:0] fit_42 = {1'b0, fit_40[43:17]} + {27'd0, fit_40[16] & (fit_40[17] | (|fit_40[15:0]))}; // u28.23
    wire [41:0] fit_47 = multiplier_product[41:0]; // u42.0
    wire [26:0] fit_49 = {1'b0, fit_47[41:16]} + {26'd0, fit_47[15] & (fit_47[16] | (|fit_47[14:0]))}; // u27.13
    wire step_is_load = step == 4'd1; // u1.0
    wire step_is_sense = step == 4'd2; // u1.0
    wire step_is_square = step == 4'd4; // u1.0
    wire step_is_finish = step == 4'd10; // u1.0
    wire step_is_drop = step == 4'd3; // u1.0
    wire bit_85 = (step_is_drop & (~(fit_42[27] == 1'd0))) | ((step_is_divide & divider_done) & divider_saturated); // u1.0
    wire [4:0] choice_88 =
        ((step_is_root & (~root_done)) | (step_is_divide & (~divider_done))) ? {1'd0, step}
        : step_is_finish ? 5'd0
        : ({1'd0, step} + 5'd1); // u5.0

    multiplier_3 u_multiplier (
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
            waited <= 1'd0;
            left <= 27'd0;
            right <= 27'd0;
            drop <= 27'd0;
            square <= 54'd0;
            root_start <= 1'd0;
            divide <= 1'd0;
            capacitance <= 24'd0;
            invalid <= 1'd0;
            saturated <= 1'd0;
            done <= 1'd0;
        end else begin
            if (start) begin
                step <= 4'd1;
                waited <= 1'd0;
                root_start <= 1'd0;
                divide <= 1'd0;
                saturated <= 1'd0;
                done <= 1'd0;
            end else if (step_is_idle) begin
                root_start <= 1'd0;
                divide <= 1'd0;
                done <= 1'd0;
            end else if (bit_39) begin
                step <= choice_88[3:0];
                waited <= 1'd0;
                root_start <= step == 4'd5;
                divide <= step_is_root & root_done;
                saturated <= saturated | (bit_85 | (step_is_finish & (~(fit_49[26:24] == 3'd0))));
                done <= step_is_finish;
                if (step == 4'd6) begin
                    invalid <= root_radicand == 54'd0;
                end
                if (step_is_finish) begin
                    capacitance <= (|fit_49[26:24]) ? {24{1'b1}} : fit_49[23:0];
                end
                if (step_is_square) begin
                    square <= multiplier_product;
                end
                if (step_is_drop) begin
                    drop <= (|fit_42[27]) ? {27{1'b1}} : fit_42[26:0];
                end
                if (step_is_load) begin
                    left <= total;
                    right <= {10'd0, sheet};
                end else if (step_is_sense) begin
                    left <= sense;
                    right <= sense;
                end else if (step_is_square) begin
                    left <= drop;
                    right <= drop;
                end else begin
                    left <= {3'd0, divider_quotient};
                    right <= {9'd0, gain};
                end
            end else begin
                waited <= 1'd1;
                root_start <= 1'd0;
                divide <= 1'd0;
                done <= 1'd0;
            end
        end
    end

    // What nothing needs.
    wire unused = &{1'b0, choice_88[4]};

endmodule

`default_nettype wire
