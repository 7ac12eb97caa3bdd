// divider: hapticore_model::blocks::divider::Divider
// Printed from the model by `hapticore hdl --profile standard`; not to be edited.

`default_nettype none

module divider (
    input wire clock,
    input wire reset,
    input wire start, // u1.0  Takes the operands and begins.
    input wire [30:0] numerator, // u31.23  What is divided; holds until the quotient is there.
    input wire [29:0] denominator, // u30.23  By what; holds likewise.
    output reg done, // u1.0  Set for one clock when the quotient is there.
    output reg [20:0] quotient, // u21.20  The quotient, held until the next is there.
    output reg saturated // u1.0  Whether the quotient is held at its rail.
);

    reg busy; // u1.0
    reg [4:0] count; // u5.0
    reg [29:0] remainder; // u30.0
    reg [20:0] tail; // u21.0
    reg over; // u1.0
    reg up; // u1.0

    wire count_is_22 = count == 5'd22; // u1.0
    wire [30:0] shifted = {remainder, tail[20] & (~count_is_22)}; // u31.0
    wire signed [31:0] rest = {1'd0, shifted} - {2'd0, denominator}; // s32.0
    wire count_is_0 = count == 5'd0; // u1.0
    wire count_is_23 = count == 5'd23; // u1.0
    wire fits = ~rest[31]; // u1.0
    wire [5:0] sum_29 = {1'd0, count} + 6'd1; // u6.0
    wire signed [31:0] choice_31 = fits ? rest : {1'd0, shifted}; // s32.0
    wire [21:0] joined_33 = {tail, fits}; // u22.0
    wire [22:0] fit_36 = {1'd0, {1'd0, tail} + {21'd0, up}}; // u23.0
    wire too_large = ~(remainder < denominator); // u1.0
    wire [50:0] fit_87 = {numerator, 20'd0}; // u51.43

    always @(posedge clock) begin
        if (reset) begin
            busy <= 1'd0;
            count <= 5'd0;
            remainder <= 30'd0;
            tail <= 21'd0;
            over <= 1'd0;
            up <= 1'd0;
            done <= 1'd0;
            quotient <= 21'd0;
            saturated <= 1'd0;
        end else begin
            if (start) begin
                busy <= 1'd1;
                count <= 5'd0;
                remainder <= fit_87[50:21];
                tail <= fit_87[20:0];
                done <= 1'd0;
            end else if (busy) begin
                if (count_is_0) begin
                    count <= sum_29[4:0];
                    over <= too_large;
                    done <= 1'd0;
                    if (too_large) begin
                        remainder <= 30'd0;
                        tail <= 21'd0;
                    end
                end else if (count_is_22) begin
                    count <= sum_29[4:0];
                    up <= fits & ((~(rest == 32'd0)) | tail[0]);
                    done <= 1'd0;
                end else if (count_is_23) begin
                    busy <= 1'd0;
                    done <= 1'd1;
                    quotient <= over ? 21'd2097151 : (|fit_36[22:21]) ? {21{1'b1}} : fit_36[20:0];
                    saturated <= (~(fit_36[22:21] == 2'd0)) | over;
                end else begin
                    count <= sum_29[4:0];
                    remainder <= choice_31[29:0];
                    tail <= joined_33[20:0];
                    done <= 1'd0;
                end
            end else begin
                done <= 1'd0;
            end
        end
    end

    // What nothing needs.
    wire unused = &{1'b0, sum_29[5], choice_31[31:30], joined_33[21]};

endmodule

`default_nettype wire
