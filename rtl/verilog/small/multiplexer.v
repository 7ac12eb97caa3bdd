// multiplexer: hapticore_model::blocks::multiplexer::Multiplexer
// Printed from the model by `hapticore hdl --profile small`; not to be edited.

`default_nettype none

module multiplexer (
    input wire clock,
    input wire reset,
    input wire strobe, // u1.0  A set of ADC codes is there.
    input wire clear, // u1.0  Abandons the slot under way; wins over `strobe`.
    output reg sample, // u1.0  Set for one clock for each sample; the flags below are about this sample.
    output reg restart, // u1.0  The first of a slot: the carrier begins anew.
    output reg integrate, // u1.0  Within the integration window.
    output reg first, // u1.0  The first of the window.
    output reg last, // u1.0  The last of the window.
    output reg [1:0] pad, // u2.0  The pad that is served.
    output reg closed // u1.0  Whether the pad's switch is made.
);

    reg [9:0] count; // u10.0
    reg [1:0] next; // u2.0

    wire count_is_849 = count == 10'd849; // u1.0
    wire [10:0] choice_18 = count_is_849 ? 11'd0 : ({1'd0, count} + 11'd1); // u11.0
    wire [2:0] choice_23 = (next == 2'd3) ? 3'd0 : ({1'd0, next} + 3'd1); // u3.0

    always @(posedge clock) begin
        if (reset) begin
            count <= 10'd0;
            next <= 2'd0;
            sample <= 1'd0;
            restart <= 1'd0;
            integrate <= 1'd0;
            first <= 1'd0;
            last <= 1'd0;
            pad <= 2'd0;
            closed <= 1'd0;
        end else begin
            if (clear) begin
                count <= 10'd0;
                next <= 2'd0;
                sample <= 1'd0;
                restart <= 1'd0;
                integrate <= 1'd0;
                first <= 1'd0;
                last <= 1'd0;
                pad <= 2'd0;
                closed <= 1'd0;
            end else begin
                sample <= strobe;
                if (strobe) begin
                    count <= choice_18[9:0];
                    restart <= count == 10'd0;
                    integrate <= ~(count < 10'd350);
                    first <= count == 10'd350;
                    last <= count_is_849;
                    pad <= next;
                    closed <= ~(count < 10'd5);
                    if (count_is_849) begin
                        next <= choice_23[1:0];
                    end
                end
            end
        end
    end

    // What nothing needs.
    wire unused = &{1'b0, choice_18[10], choice_23[2]};

endmodule

`default_nettype wire
