// divider_2: hapticore_model::blocks::divider::Divider
// Printed from the model by `hapticore hdl --profile standard`; not to be edited.

`default_nettype none

module divider_2 (
    input wire clock,
    input wire reset,
    input wire start, // u1.0  Takes the operands and begins.
    input wire [26:0] numerator, // u27.23  What is divided; holds until the quotient is there.
    input wire [27:0] denominator, // u28.23  By what; holds likewise.
    output reg done, // u1.0  Set for one clock when the quotient is there.
    output reg [23:0] quotient, // u24.22  The quotient, held until the next is there.
    output reg saturated // u1.0  Whether the quotient is held at its rail.
);

    reg busy; // u1.0
    reg [4:0] count; // u5.0
    reg [27:0] remainder; // u28.0
    reg [23:0] tail; // u24.0
    reg over; // u1.0
    reg up; // u1.0

    wire count_is_25 = count == 5'd25; // u1.0
    wire [28:0] shifted = {remainder, tail[23] & (~count_is_25)}; // u29.0
    wire signed [29:0] rest = {1'd0, shifted} - {2'd0, denominator}; // s30.0
    wire count_is_0 = count == 5'd0; // u1.0
    wire count_is_26 = count == 5'd26; // u1.0
    wire fits = ~rest[29]; // u1.0
    wire [5:0] sum_29 = {1'd0, count} + 6'd1; // u6.0
    wire signed [29:0] choice_31 = fits ? rest : {1'd0, shifted}; // s30.0
    wire [24:0] joined_33 = {tail, fits}; // u25.0
    wire [25:0] fit_36 = {1'd0, {1'd0, tail} + {24'd0, up}}; // u26.0
    wire too_large = ~(remainder < denominator); // u1.0
    wire [48:0] fit_87 = {numerator, 22'd0}; // u49.45

    always @(posedge clock) begin
        if (reset) begin
            busy <= 1'd0;
            count <= 5'd0;
            remainder <= 28'd0;
            tail <= 24'd0;
            over <= 1'd0;
            up <= 1'd0;
            done <= 1'd0;
            quotient <= 24'd0;
            saturated <= 1'd0;
        end else begin
            if (start) begin
                busy <= 1'd1;
                count <= 5'd0;
                remainder <= {3'd0, fit_87[48:24]};
                tail <= fit_87[23:0];
                done <= 1'd0;
            end else if (busy) begin
                if (count_is_0) begin
                    count <= sum_29[4:0];
                    over <= too_large;
                    done <= 1'd0;
                    if (too_large) begin
                        remainder <= 28'd0;
                        tail <= 24'd0;
                    end
                end else if (count_is_25) begin
                    count <= sum_29[4:0];
                    up <= fits & ((~(rest == 30'd0)) | tail[0]);
                    done <= 1'd0;
                end else if (count_is_26) begin
                    busy <= 1'd0;
                    done <= 1'd1;
                    quotient <= over ? 24'd16777215 : (|fit_36[25:24]) ? {24{1'b1}} : fit_36[23:0];
                    saturated <= (~(fit_36[25:24] == 2'd0)) | over;
                end else begin
                    count <= sum_29[4:0];
                    remainder <= choice_31[27:0];
                    tail <= joined_33[23:0];
                    done <= 1'd0;
                end
            end else begin
                done <= 1'd0;
            end
        end
    end

    // What nothing needs.
    wire unused = &{1'b0, sum_29[5], choice_31[29:28], joined_33[24]};

endmodule

`default_nettype wire
