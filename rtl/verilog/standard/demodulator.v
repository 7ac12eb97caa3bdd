// demodulator: hapticore_model::blocks::demodulator::Demodulator
// Printed from the model by `hapticore hdl --profile standard`; not to be edited.

`default_nettype none

module demodulator (
    input wire clock,
    input wire reset,
    input wire start, // u1.0  The oscillator's outputs are those of a sample to be integrated.
    input wire first, // u1.0  The sample is the first of its window.
    input wire last, // u1.0  The sample is the last of its window.
    input wire [1:0] pad, // u2.0  The pad that is served.
    input wire signed [17:0] code, // s18.17  The code of the channel asked for in the clock before.
    input wire signed [17:0] cosine, // s18.17  The oscillator's.
    input wire signed [17:0] sine, // s18.17  The oscillator's.
    input wire signed [17:0] window, // s18.17  The oscillator's.
    input wire phase, // u1.0  The oscillator's.
    output wire [2:0] channel, // u3.0  The channel whose code is wanted in the next clock.
    output reg valid, // u1.0  Set for a clock for each finished sum of a window.
    output reg [3:0] index, // u4.0  Which sum: 2k the in-phase and 2k + 1 the quadrature of channel k, the last the mean square.
    output reg signed [44:0] sum, // s45.34  The sum.
    output wire [1:0] pad_out, // u2.0  The pad of the window.
    output reg clipped // u1.0  Whether a code of the window was at a rail.
);

    reg busy; // u1.0
    reg [4:0] step; // u5.0
    reg first_q; // u1.0
    reg last_q; // u1.0
    reg [1:0] pad_q; // u2.0
    reg signed [17:0] left; // s18.17
    reg signed [17:0] right; // s18.17
    reg signed [17:0] weighted; // s18.17
    reg [16:0] residue; // u17.34
    reg [16:0] other_residue; // u17.34
    reg summed; // u1.0
    (* no_rw_check *) // nobody uses a word that was read while it was being written
    reg signed [44:0] sums [0:15]; // 16 words s45.34
    reg signed [44:0] sums_word; // its read register
    (* no_rw_check *) // nobody uses a word that was read while it was being written
    (* ram_style = "block" *)
    reg signed [17:0] weights [0:3]; // 4 words s18.17
    reg signed [17:0] weights_word; // its read register
    wire signed [35:0] multiplier_product; // s36.0

    wire signed [5:0] difference_33 = {1'd0, step} - 6'd2; // s6.0
    wire bit_36 = ~(step < 5'd2); // u1.0
    wire less_46 = step < 5'd5; // u1.0
    wire bit_48 = (~less_46) & busy; // u1.0
    wire signed [5:0] difference_45 = {1'd0, step} - 6'd5; // s6.0
    wire signed [5:0] difference_51 = {1'd0, step} - 6'd4; // s6.0
    wire signed [44:0] so_far = first_q ? 45'd0 : sums_word; // s45.34
    wire signed [45:0] accumulated = {{1{so_far[44]}}, so_far} + {{10{multiplier_product[35]}}, multiplier_product}; // s46.34
    wire signed [5:0] difference_67 = {1'd0, step} - 6'd3; // s6.0
    wire weighing = step < 5'd3; // u1.0
    wire step_is_16 = step == 5'd16; // u1.0
    wire step_is_19 = step == 5'd19; // u1.0
    wire bit_94 = bit_36 & less_46; // u1.0
    wire of_wave = (step == 5'd2) | (step == 5'd3); // u1.0
    wire signed [36:0] carried = {{1{multiplier_product[35]}}, multiplier_product} + {20'd0, first_q ? 17'd65536 : residue}; // s37.34
    wire signed [17:0] fit_105 = multiplier_product[34:17] + {17'd0, multiplier_product[16] & (multiplier_product[17] | (|multiplier_product[15:0]))}; // s18.17
    wire [5:0] choice_114 = step_is_19 ? 6'd0 : ({1'd0, step} + 6'd1); // u6.0
    wire bit_123 = clipped | ((bit_36 & (step < 5'd18)) ? ((code == 18'd131071) | (code == 18'h20000)) : 1'd0); // u1.0

    multiplier u_multiplier (
        .clock(clock),
        .reset(reset),
        .enable(busy),
        .left(left),
        .right(right),
        .product(multiplier_product)
    );

    initial begin : initial_sums
        integer i;
        for (i = 0; i < 16; i = i + 1) sums[i] = 45'd0;
    end

    always @(posedge clock) begin
        if (summed) sums[index] <= sum;
        sums_word <= sums[difference_51[3:0]];
    end

    initial begin : initial_weights
        integer i;
        for (i = 0; i < 4; i = i + 1) weights[i] = 18'd0;
    end

    always @(posedge clock) begin
        if ((busy & (~weighing)) & (step < 5'd6)) weights[difference_67[1:0]] <= weighted;
        weights_word <= weights[{step_is_16, difference_33[0] & (~step_is_16)}];
    end

    always @(posedge clock) begin
        if (reset) begin
            busy <= 1'd0;
            step <= 5'd0;
            first_q <= 1'd0;
            last_q <= 1'd0;
            pad_q <= 2'd0;
            left <= 18'd0;
            right <= 18'd0;
            weighted <= 18'd0;
            residue <= 17'd0;
            other_residue <= 17'd0;
            valid <= 1'd0;
            summed <= 1'd0;
            index <= 4'd0;
            sum <= 45'd0;
            clipped <= 1'd0;
        end else begin
            if (start) begin
                busy <= 1'd1;
                step <= 5'd0;
                first_q <= first;
                last_q <= last;
                pad_q <= pad;
                valid <= 1'd0;
                summed <= 1'd0;
                if (first) begin
                    clipped <= 1'd0;
                end
            end else if (busy) begin
                busy <= ~step_is_19;
                step <= choice_114[4:0];
                valid <= bit_48 & last_q;
                summed <= bit_48;
                index <= difference_45[3:0];
                sum <= accumulated[44:0];
                clipped <= bit_123;
                if (weighing) begin
                    left <= window;
                    right <= (step == 5'd0) ? cosine : (step == 5'd1) ? sine : code;
                end else begin
                    left <= code;
                    right <= less_46 ? weighted : weights_word;
                end
                if (bit_94) begin
                    weighted <= (step == 5'd4) ? fit_105 : carried[34:17];
                    if (of_wave) begin
                        residue <= other_residue;
                        other_residue <= carried[16:0];
                    end
                end
            end else begin
                valid <= 1'd0;
                summed <= 1'd0;
            end
        end
    end

    assign channel = (bit_36 & (step < 5'd16)) ? difference_33[3:1] : 3'd7;
    assign pad_out = pad_q;

    // What nothing needs.
    wire unused = &{1'b0, phase, difference_33[5:4], difference_45[5:4], difference_51[5:4], accumulated[45],
        difference_67[5:2], carried[36:35], choice_114[5]};

endmodule

`default_nettype wire
