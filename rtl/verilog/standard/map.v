// map: hapticore_model::blocks::map::Map
// Printed from the model by `hapticore hdl --profile standard`; not to be edited.

`default_nettype none

module map (
    input wire clock,
    input wire reset,
    input wire start, // u1.0  The ratios are there, and hold.
    input wire signed [21:0] r_x, // s22.20  The x ratio.
    input wire signed [21:0] r_y, // s22.20  The y ratio.
    input wire signed [21:0] origin_x, // s22.20  Calibration: the x ratio in the middle of the box.
    input wire [17:0] scale_x, // u18.13  Calibration: one over half the box's width.
    input wire signed [21:0] origin_y, // s22.20  Calibration: the y ratio in the middle of the box.
    input wire [17:0] scale_y, // u18.13  Calibration: one over half the box's height.
    input wire write, // u1.0  Calibration: writes a word of the tables.
    input wire [11:0] address, // u12.0  Calibration: where.
    input wire signed [17:0] word, // s18.17  Calibration: what.
    output reg done, // u1.0  Set for one clock when the others are there.
    output reg signed [17:0] x, // s18.8  The position along the long edges, in mm from the middle.
    output reg signed [17:0] y, // s18.8  The position along the short edges, in mm from the middle.
    output reg [16:0] sheet, // u17.17  The sheet's resistance at the pad, in full scales of voltage per current.
    output reg saturated // u1.0  Whether a word is held at a rail.
);

    reg busy; // u1.0
    reg [4:0] operation; // u5.0  0 box_x, 1 box_y, 2 middle_y, 3 stretch_y, 4 straighten_y, 5 spacing_y, 6 middle_x, 7 stretch_x, 8 straighten_x, 9 spacing_x, 10 x_above, 11 x_below, 12 x, 13 y_above, 14 y_below, 15 y, 16 r_above, 17 r_below, 18 r
    reg [3:0] step; // u4.0  0 cell, 1 row, 2 look_up, 3 look_up_next, 4 near, 5 far, 6 difference, 7 multiply
    reg signed [17:0] across; // s18.17
    reg signed [17:0] along; // s18.17
    reg signed [17:0] first; // s18.17
    reg signed [17:0] second; // s18.17
    reg [11:0] base; // u12.0
    reg signed [17:0] word_q; // s18.17
    reg signed [21:0] near; // s22.0
    reg signed [22:0] difference; // s23.0
    reg [17:0] factor; // u18.0
    reg signed [40:0] aligned; // s41.33
    reg signed [17:0] result; // s18.17
    (* no_rw_check *) // nobody uses a word that was read while it was being written
    reg signed [17:0] words [0:3784]; // 3785 words s18.17
    reg signed [17:0] words_word; // its read register
    wire signed [40:0] multiplier_product; // s41.0

    wire [12:0] sum_35 = {1'd0, base} + {12'd0, step == 4'd3}; // u13.0
    wire operation_is_box_x = operation == 5'd0; // u1.0
    wire operation_is_box_y = operation == 5'd1; // u1.0
    wire boxed = operation_is_box_x | operation_is_box_y; // u1.0
    wire operation_is_straighten_y = operation == 5'd4; // u1.0
    wire operation_is_straighten_x = operation == 5'd8; // u1.0
    wire straightened = operation_is_straighten_y | operation_is_straighten_x; // u1.0
    wire operation_is_spacing_y = operation == 5'd5; // u1.0
    wire operation_is_spacing_x = operation == 5'd9; // u1.0
    wire spaced = operation_is_spacing_y | operation_is_spacing_x; // u1.0
    wire tables = ~(operation < 5'd10); // u1.0
    wire below = ((operation == 5'd11) | (operation == 5'd14)) | (operation == 5'd17); // u1.0
    wire operation_is_x = operation == 5'd12; // u1.0
    wire operation_is_y = operation == 5'd15; // u1.0
    wire operation_is_r = operation == 5'd18; // u1.0
    wire between = (operation_is_x | operation_is_y) | operation_is_r; // u1.0
    wire [4:0] sum_72 = {1'd0, step} + 5'd1; // u5.0
    wire step_is_cell = step == 4'd0; // u1.0
    wire step_is_row = step == 4'd1; // u1.0
    wire step_is_9 = step == 4'd9; // u1.0
    wire step_is_10 = step == 4'd10; // u1.0
    wire step_is_11 = step == 4'd11; // u1.0
    wire bit_81 = ~((boxed | straightened) | between); // u1.0
    wire signed [23:0] difference_82 = {{1{difference[22]}}, difference} - {{2{near[21]}}, near}; // s24.0
    wire of_x = (operation_is_box_x | operation_is_straighten_x) | operation_is_spacing_x; // u1.0
    wire of_y = (operation_is_box_y | operation_is_straighten_y) | operation_is_spacing_y; // u1.0
    wire operation_is_stretch_y = operation == 5'd3; // u1.0
    wire operation_is_stretch_x = operation == 5'd7; // u1.0
    wire bit_103 = (operation_is_stretch_y | operation_is_stretch_x) | below; // u1.0
    wire [5:0] choice_106 = operation_is_r ? 6'd0 : ({1'd0, operation} + 6'd1); // u6.0
    wire signed [25:0] fit_131 = {aligned[40], aligned[40:16]} + {25'd0, aligned[15] & (aligned[16] | (|aligned[14:0]))}; // s26.17
    wire signed [31:0] fit_158 = multiplier_product[31:0]; // s32.0
    wire signed [17:0] fit_160 = near[17:0]; // s18.0
    wire signed [32:0] sum_162 = {{1{fit_158[31]}}, fit_158} + {{2{fit_160[17]}}, fit_160, 13'd0}; // s33.30
    wire signed [36:0] choice_163 = straightened ? {multiplier_product[35:0], 1'd0} : {{4{sum_162[32]}}, sum_162}; // s37.30
    wire signed [19:0] sum_181 = {{2{along[17]}}, along} + 20'd131072; // s20.17
    wire [17:0] fit_182 = sum_181[17:0]; // u18.17
    wire [5:0] sum_187 = {1'd0, fit_182[17:13]} + {5'd0, below}; // u6.0
    wire [12:0] choice_192 =
        tables ? ({1'd0, base} + {1'd0, {1'd0, {sum_187, 5'd0}} + {6'd0, sum_187}})
        : {1'd0, base}; // u13.0
    wire operation_is_middle_y = operation == 5'd2; // u1.0
    wire bit_215 = ((operation_is_middle_y | operation_is_stretch_y) | operation_is_straighten_x) | operation_is_spacing_x; // u1.0
    wire signed [17:0] coordinate = (bit_215 | (tables & (~between))) ? across : along; // s18.17
    wire signed [19:0] sum_220 = {{2{coordinate[17]}}, coordinate} + 20'd131072; // s20.17
    wire [17:0] fit_221 = sum_220[17:0]; // u18.17
    wire signed [18:0] difference_224 = {1'd0, fit_221} - {1'd0, fit_221[17:12], 12'd0}; // s19.12
    wire signed [18:0] difference_228 = {1'd0, fit_221} - {1'd0, fit_221[17:11], 11'd0}; // s19.11
    wire signed [18:0] difference_232 = {1'd0, fit_221} - {1'd0, fit_221[17:13], 13'd0}; // s19.13
    wire [12:0] sum_268 = {1'd0, tables ? ((~(operation < 5'd16)) ? 12'd2696 : {1'd0, (~(operation < 5'd13)) ? 11'd1607 : 11'd518}) : {3'd0, operation_is_spacing_y ? 9'd260 : operation_is_stretch_x ? 9'd195 : (operation == 5'd6) ? 9'd130 : operation_is_stretch_y ? 9'd65 : operation_is_middle_y ? 9'd0 : 9'd389}} + {6'd0, tables ? {2'd0, fit_221[17:13]} : spaced ? fit_221[17:11] : {1'd0, fit_221[17:12]}}; // u13.0
    wire signed [17:0] choice_278 = straightened ? (operation_is_straighten_x ? across : along) : second; // s18.0
    wire signed [21:0] choice_279 = boxed ? (operation_is_box_x ? r_x : r_y) : {{4{choice_278[17]}}, choice_278}; // s22.0

    multiplier_3 u_multiplier (
        .clock(clock),
        .reset(reset),
        .enable(busy),
        .left(difference),
        .right(factor),
        .product(multiplier_product)
    );

    initial begin : initial_words
        integer i;
        for (i = 0; i < 3785; i = i + 1) words[i] = 18'd0;
    end

    always @(posedge clock) begin
        if (write) words[address] <= word;
        words_word <= words[sum_35[11:0]];
    end

    always @(posedge clock) begin
        if (reset) begin
            busy <= 1'd0;
            operation <= 5'd0;
            step <= 4'd0;
            across <= 18'd0;
            along <= 18'd0;
            first <= 18'd0;
            second <= 18'd0;
            base <= 12'd0;
            word_q <= 18'd0;
            near <= 22'd0;
            difference <= 23'd0;
            factor <= 18'd0;
            aligned <= 41'd0;
            result <= 18'd0;
            x <= 18'd0;
            y <= 18'd0;
            sheet <= 17'd0;
            saturated <= 1'd0;
            done <= 1'd0;
        end else begin
            if (start) begin
                busy <= 1'd1;
                operation <= 5'd0;
                step <= 4'd0;
                saturated <= 1'd0;
                done <= 1'd0;
            end else if (busy) begin
                word_q <= words_word;
                if (step_is_cell) begin
                    step <= sum_72[3:0];
                    base <= sum_268[11:0];
                    difference <= {{1{choice_279[21]}}, choice_279};
                    done <= 1'd0;
                    if (boxed) begin
                        if (operation_is_box_x) begin
                            near <= origin_x;
                            factor <= scale_x;
                        end else begin
                            near <= origin_y;
                            factor <= scale_y;
                        end
                    end else begin
                        near <= {{4{first[17]}}, first};
                        factor <= {1'd0, straightened ? (second[17] ? 17'd0 : second[16:0]) : {4'd0, tables ? difference_232[12:0] : spaced ? {difference_228[10:0], 2'd0} : {difference_224[11:0], 1'd0}}};
                    end
                end else if (step_is_row) begin
                    step <= sum_72[3:0];
                    base <= choice_192[11:0];
                    done <= 1'd0;
                end else if (step_is_9) begin
                    step <= sum_72[3:0];
                    aligned <= boxed ? multiplier_product : {{1{choice_163[36]}}, choice_163, 3'd0};
                    done <= 1'd0;
                end else if (step_is_10) begin
                    step <= sum_72[3:0];
                    result <=
                        (fit_131[25:17] == {9{fit_131[25]}}) ? fit_131[17:0] : {fit_131[25], {17{~fit_131[25]}}};
                    saturated <= saturated | (~((fit_131[25:17] == 9'd0) | (fit_131[25:17] == 9'd511)));
                    done <= 1'd0;
                end else if (step_is_11) begin
                    busy <= ~operation_is_r;
                    operation <= choice_106[4:0];
                    step <= 4'd0;
                    done <= operation_is_r;
                    if (operation_is_r) begin
                        sheet <= result[17] ? 17'd0 : result[16:0];
                    end
                    if (operation_is_y) begin
                        y <= result;
                    end
                    if (operation_is_x) begin
                        x <= result;
                    end
                    if (bit_103) begin
                        second <= result;
                    end
                    if (~((of_x | of_y) | bit_103)) begin
                        first <= result;
                    end
                    if (of_y) begin
                        along <= result;
                    end
                    if (of_x) begin
                        across <= result;
                    end
                end else begin
                    step <= sum_72[3:0];
                    difference <=
                        (sum_72[3:0] == 4'd7) ? difference_82[22:0]
                        : ((sum_72[3:0] == 4'd6) & bit_81) ? {{5{word_q[17]}}, word_q}
                        : difference;
                    done <= 1'd0;
                    if ((sum_72[3:0] == 4'd5) & bit_81) begin
                        near <= {{4{word_q[17]}}, word_q};
                    end
                end
            end else begin
                done <= 1'd0;
            end
        end
    end

    // What nothing needs.
    wire unused = &{1'b0, sum_35[12], sum_72[4], difference_82[23], choice_106[5], sum_181[19:18], fit_182[12:0],
        choice_192[12], sum_220[19:18], difference_224[18:12], difference_228[18:11], difference_232[18:13],
        sum_268[12]};

endmodule

`default_nettype wire
