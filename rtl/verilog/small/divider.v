// divider: hapticore_model::blocks::divider::Divider
// Printed from the model by `hapticore hdl --profile small`; not to be edited.

`default_nettype none

module divider (
    input wire clock,
    input wire reset,
    input wire start, // u1.0  Takes the operands and begins.
    input wire [20:0] numerator, // u21.15  What is divided; holds until the quotient is there.
    input wire [19:0] denominator, // u20.15  By what; holds likewise.
    output reg done, // u1.0  Set for one clock when the quotient is there.
    output reg [16:0] quotient, // u17.16  The quotient, held until the next is there.
    output reg saturated // u1.0  Whether the quotient is held at its rail.
);

    reg busy; // u1.0
    reg [4:0] count; // u5.0
    reg [19:0] remainder; // u20.0
    reg [16:0] tail; // u17.0
    reg over; // u1.0
    reg up; // u1.0

    wire count_is_18 = count == 5'd18; // u1.0
    wire [20:0] shifted = {remainder, tail[16] & (~count_is_18)}; // u21.0
    wire signed [21:0] rest = {1'd0, shifted} - {2'd0, denominator}; // s22.0
    wire count_is_0 = count == 5'd0; // u1.0
    wire count_is_19 = count == 5'd19; // u1.0
    wire fits = ~rest[21]; // u1.0
    wire [5:0] sum_29 = {1'd0, count} + 6'd1; // u6.0
    wire signed [21:0] choice_31 = fits ? rest : {1'd0, shifted}; // s22.0
    wire [17:0] joined_33 = {tail, fits}; // u18.0
    wire [18:0] fit_36 = {1'd0, {1'd0, tail} + {17'd0, up}}; // u19.0
    wire too_large = ~(remainder < denominator); // u1.0
    wire [36:0] fit_87 = {numerator, 16'd0}; // u37.31

    always @(posedge clock) begin
        if (reset) begin
            busy <= 1'd0;
            count <= 5'd0;
            remainder <= 20'd0;
            tail <= 17'd0;
            over <= 1'd0;
            up <= 1'd0;
            done <= 1'd0;
            quotient <= 17'd0;
            saturated <= 1'd0;
        end else begin
            if (start) begin
                busy <= 1'd1;
                count <= 5'd0;
                remainder <= fit_87[36:17];
                tail <= fit_87[16:0];
                done <= 1'd0;
            end else if (busy) begin
                if (count_is_0) begin
                    count <= sum_29[4:0];
                    over <= too_large;
                    done <= 1'd0;
                    if (too_large) begin
                        remainder <= 20'd0;
                        tail <= 17'd0;
                    end
                end else if (count_is_18) begin
                    count <= sum_29[4:0];
                    up <= fits & ((~(rest == 22'd0)) | tail[0]);
                    done <= 1'd0;
                end else if (count_is_19) begin
                    busy <= 1'd0;
                    done <= 1'd1;
                    quotient <= over ? 17'd131071 : (|fit_36[18:17]) ? {17{1'b1}} : fit_36[16:0];
                    saturated <= (~(fit_36[18:17] == 2'd0)) | over;
                end else begin
                    count <= sum_29[4:0];
                    remainder <= choice_31[19:0];
                    tail <= joined_33[16:0];
                    done <= 1'd0;
                end
            end else begin
                done <= 1'd0;
            end
        end
    end

    // What nothing needs.
    wire unused = &{1'b0, sum_29[5], choice_31[21:20], joined_33[17]};

endmodule

`default_nettype wire
