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
    reg [2:0] step; // u3.0  0 coordinate, 1 near, 2 far, 3 difference, 4 multiply, 5 finish
    reg signed [17:0] p_x; // s18.17
    reg signed [17:0] p_y; // s18.17
    reg signed [17:0] middle; // s18.17
    reg signed [17:0] stretch; // s18.17
    reg signed [17:0] u; // s18.17
    reg signed [17:0] v; // s18.17
    reg signed [17:0] above; // s18.17
    reg signed [17:0] below; // s18.17
    reg [11:0] base; // u12.0
    reg signed [17:0] near; // s18.17
    reg signed [22:0] difference; // s23.0
    reg [17:0] factor; // u18.0
    reg signed [40:0] product; // s41.0
    reg signed [17:0] words [0:3784]; // 3785 words s18.17
    reg signed [17:0] words_word; // its read register

    wire step_is_far = step == 3'd2; // u1.0
    wire [12:0] sum_37 = {1'd0, base} + {12'd0, step_is_far}; // u13.0
    wire operation_is_box_x = operation == 5'd0; // u1.0
    wire operation_is_box_y = operation == 5'd1; // u1.0
    wire bit_43 = operation_is_box_x | operation_is_box_y; // u1.0
    wire operation_is_straighten_y = operation == 5'd4; // u1.0
    wire operation_is_straighten_x = operation == 5'd8; // u1.0
    wire bit_48 = operation_is_straighten_y | operation_is_straighten_x; // u1.0
    wire operation_is_x = operation == 5'd12; // u1.0
    wire operation_is_y = operation == 5'd15; // u1.0
    wire operation_is_r = operation == 5'd18; // u1.0
    wire bit_57 = (operation_is_x | operation_is_y) | operation_is_r; // u1.0
    wire bit_59 = ~((bit_43 | bit_48) | bit_57); // u1.0
    wire step_is_finish = step == 3'd5; // u1.0
    wire [3:0] choice_63 = step_is_finish ? 4'd0 : ({1'd0, step} + 4'd1); // u4.0
    wire signed [17:0] choice_66 = (step_is_far & bit_59) ? words_word : near; // s18.17
    wire signed [18:0] difference_70 = {{1{words_word[17]}}, words_word} - {{1{near[17]}}, near}; // s19.17
    wire signed [22:0] choice_72 =
        ((step == 3'd3) & bit_59) ? {{4{difference_70[18]}}, difference_70}
        : difference; // s23.0
    wire signed [40:0] product_74 = difference * $signed({1'b0, factor}); // s41.0
    wire signed [40:0] choice_75 = (step == 3'd4) ? product_74 : product; // s41.0
    wire step_is_coordinate = step == 3'd0; // u1.0
    wire operation_is_middle_y = operation == 5'd2; // u1.0
    wire operation_is_stretch_y = operation == 5'd3; // u1.0
    wire bit_79 = operation_is_middle_y | operation_is_stretch_y; // u1.0
    wire signed [17:0] choice_80 = bit_79 ? p_x : v; // s18.17
    wire signed [19:0] sum_81 = {{2{choice_80[17]}}, choice_80} + 20'd131072; // s20.17
    wire [17:0] fit_82 = sum_81[17:0]; // u18.17
    wire signed [18:0] difference_85 = {1'd0, fit_82} - {1'd0, fit_82[17:12], 12'd0}; // s19.12
    wire operation_is_spacing_y = operation == 5'd5; // u1.0
    wire signed [17:0] choice_88 = operation_is_spacing_y ? v : u; // s18.17
    wire signed [19:0] sum_89 = {{2{choice_88[17]}}, choice_88} + 20'd131072; // s20.17
    wire [17:0] fit_90 = sum_89[17:0]; // u18.17
    wire signed [18:0] difference_93 = {1'd0, fit_90} - {1'd0, fit_90[17:11], 11'd0}; // s19.11
    wire operation_is_middle_x = operation == 5'd6; // u1.0
    wire operation_is_spacing_x = operation == 5'd9; // u1.0
    wire bit_108 = operation_is_spacing_y | operation_is_spacing_x; // u1.0
    wire [8:0] sum_110 = {1'd0, bit_79 ? {1'd0, operation_is_middle_y ? 7'd0 : 7'd65} : operation_is_middle_x ? 8'd130 : 8'd195} + {3'd0, fit_82[17:12]}; // u9.0
    wire signed [19:0] sum_112 = {{2{u[17]}}, u} + 20'd131072; // s20.17
    wire [17:0] fit_113 = sum_112[17:0]; // u18.17
    wire signed [18:0] difference_116 = {1'd0, fit_113} - {1'd0, fit_113[17:13], 13'd0}; // s19.13
    wire signed [19:0] sum_118 = {{2{v[17]}}, v} + 20'd131072; // s20.17
    wire [17:0] fit_119 = sum_118[17:0]; // u18.17
    wire signed [18:0] difference_122 = {1'd0, fit_119} - {1'd0, fit_119[17:13], 13'd0}; // s19.13
    wire bit_131 = ((operation == 5'd11) | (operation == 5'd14)) | (operation == 5'd17); // u1.0
    wire [5:0] sum_132 = {1'd0, fit_119[17:13]} + {5'd0, bit_131}; // u6.0
    wire [12:0] sum_147 = {1'd0, (~(operation < 5'd16)) ? 12'd2696 : {1'd0, (~(operation < 5'd13)) ? 11'd1607 : 11'd518}} + {1'd0, {1'd0, {sum_132, 5'd0}} + {6'd0, sum_132}}; // u13.0
    wire bit_152 = ~(operation < 5'd10); // u1.0
    wire [13:0] choice_155 =
        bit_152 ? ({1'd0, sum_147} + {9'd0, fit_113[17:13]})
        : {4'd0, bit_108 ? ({1'd0, operation_is_spacing_y ? 9'd260
        : 9'd389} + {3'd0, fit_90[17:11]})
        : {1'd0, sum_110}}; // u14.0
    wire signed [21:0] choice_157 = operation_is_box_x ? r_x : r_y; // s22.20
    wire signed [21:0] choice_158 = operation_is_box_x ? origin_x : origin_y; // s22.20
    wire signed [17:0] choice_160 = operation_is_straighten_y ? p_y : p_x; // s18.17
    wire signed [18:0] choice_167 =
        bit_48 ? ({{1{choice_160[17]}}, choice_160} - {{1{middle[17]}}, middle})
        : ({{1{below[17]}}, below} - {{1{above[17]}}, above}); // s19.0
    wire signed [25:0] fit_177 = {choice_75[40], choice_75[40:16]} + {25'd0, choice_75[15] & (choice_75[16] | (|choice_75[14:0]))}; // s26.17
    wire signed [17:0] fit_178 =
        (fit_177[25:17] == {9{fit_177[25]}}) ? fit_177[17:0] : {fit_177[25], {17{~fit_177[25]}}}; // s18.17
    wire signed [35:0] fit_181 = choice_75[35:0]; // s36.0
    wire signed [24:0] fit_184 = {fit_181[35], fit_181[35:12]} + {24'd0, fit_181[11] & (fit_181[12] | (|fit_181[10:0]))}; // s25.17
    wire signed [17:0] fit_185 =
        (fit_184[24:17] == {8{fit_184[24]}}) ? fit_184[17:0] : {fit_184[24], {17{~fit_184[24]}}}; // s18.17
    wire signed [31:0] fit_188 = choice_75[31:0]; // s32.0
    wire signed [32:0] sum_190 = {{2{choice_66[17]}}, choice_66, 13'd0} + {{1{fit_188[31]}}, fit_188}; // s33.30
    wire signed [20:0] fit_191 = {sum_190[32], sum_190[32:13]} + {20'd0, sum_190[12] & (sum_190[13] | (|sum_190[11:0]))}; // s21.17
    wire signed [17:0] fit_192 =
        (fit_191[20:17] == {4{fit_191[20]}}) ? fit_191[17:0] : {fit_191[20], {17{~fit_191[20]}}}; // s18.17
    wire signed [17:0] choice_196 = bit_43 ? fit_178 : bit_48 ? fit_185 : fit_192; // s18.17
    wire [5:0] choice_202 = operation_is_r ? 6'd0 : ({1'd0, operation} + 6'd1); // u6.0
    wire bit_227 = saturated | (bit_43 ? (~({{8{fit_178[17]}}, fit_178} == fit_177)) : bit_48 ? (~({{7{fit_185[17]}}, fit_185} == fit_184)) : (~({{3{fit_192[17]}}, fit_192} == fit_191))); // u1.0

    initial begin : initial_words
        integer i;
        for (i = 0; i < 3785; i = i + 1) words[i] = 18'd0;
    end

    always @(posedge clock) begin
        if (write) words[address] <= word;
        words_word <= words[sum_37[11:0]];
    end

    always @(posedge clock) begin
        if (reset) begin
            busy <= 1'd0;
            operation <= 5'd0;
            step <= 3'd0;
            p_x <= 18'd0;
            p_y <= 18'd0;
            middle <= 18'd0;
            stretch <= 18'd0;
            u <= 18'd0;
            v <= 18'd0;
            above <= 18'd0;
            below <= 18'd0;
            base <= 12'd0;
            near <= 18'd0;
            difference <= 23'd0;
            factor <= 18'd0;
            product <= 41'd0;
            x <= 18'd0;
            y <= 18'd0;
            sheet <= 17'd0;
            saturated <= 1'd0;
            done <= 1'd0;
        end else begin
            if (start) begin
                busy <= 1'd1;
                operation <= 5'd0;
                step <= 3'd0;
                saturated <= 1'd0;
                done <= 1'd0;
            end else if (busy) begin
                if (step_is_coordinate) begin
                    step <= choice_63[2:0];
                    base <= choice_155[11:0];
                    near <= bit_57 ? above : choice_66;
                    product <= choice_75;
                    done <= 1'd0;
                    if (bit_43) begin
                        difference <= {{1{choice_157[21]}}, choice_157} - {{1{choice_158[21]}}, choice_158};
                        factor <= operation_is_box_x ? scale_x : scale_y;
                    end else begin
                        difference <= {{4{choice_167[18]}}, choice_167};
                        factor <= {1'd0, bit_48 ? (stretch[17] ? 17'd0 : stretch[16:0]) : {4'd0, bit_152 ? (bit_57 ? difference_122[12:0] : difference_116[12:0]) : bit_108 ? {difference_93[10:0], 2'd0} : {difference_85[11:0], 1'd0}}};
                    end
                end else if (step_is_finish) begin
                    busy <= ~operation_is_r;
                    operation <= choice_202[4:0];
                    step <= choice_63[2:0];
                    near <= choice_66;
                    difference <= choice_72;
                    product <= choice_75;
                    saturated <= bit_227;
                    done <= operation_is_r;
                    if (operation_is_r) begin
                        sheet <= choice_196[17] ? 17'd0 : choice_196[16:0];
                    end
                    if (operation_is_y) begin
                        y <= choice_196;
                    end
                    if (operation_is_x) begin
                        x <= choice_196;
                    end
                    if (bit_131) begin
                        below <= choice_196;
                    end
                    if (((operation == 5'd10) | (operation == 5'd13)) | (operation == 5'd16)) begin
                        above <= choice_196;
                    end
                    if (operation_is_straighten_y | operation_is_spacing_y) begin
                        v <= choice_196;
                    end
                    if (operation_is_straighten_x | operation_is_spacing_x) begin
                        u <= choice_196;
                    end
                    if (operation_is_stretch_y | (operation == 5'd7)) begin
                        stretch <= choice_196;
                    end
                    if (operation_is_middle_y | operation_is_middle_x) begin
                        middle <= choice_196;
                    end
                    if (operation_is_box_y) begin
                        p_y <= choice_196;
                    end
                    if (operation_is_box_x) begin
                        p_x <= choice_196;
                    end
                end else begin
                    step <= choice_63[2:0];
                    near <= choice_66;
                    difference <= choice_72;
                    product <= choice_75;
                    done <= 1'd0;
                end
            end else begin
                done <= 1'd0;
            end
        end
    end

    // What nothing needs.
    wire unused = &{1'b0, sum_37[12], choice_63[3], sum_81[19:18], difference_85[18:12], sum_89[19:18],
        difference_93[18:11], sum_112[19:18], difference_116[18:13], sum_118[19:18], difference_122[18:13],
        choice_155[13:12], choice_202[5]};

endmodule

`default_nettype wire
