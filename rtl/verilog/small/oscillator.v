// oscillator: hapticore_model::blocks::oscillator::Oscillator
// Printed from the model by `hapticore hdl --profile small`; not to be edited.

`default_nettype none

module oscillator (
    input wire clock,
    input wire reset,
    input wire sample, // u1.0  A sample is there.
    input wire restart, // u1.0  It is the first of its slot.
    input wire first, // u1.0  It is the first of its window.
    output reg ready, // u1.0  Set for one clock before the other outputs are those of the sample.
    output wire signed [16:0] cosine, // s17.16  The cosine of the carrier.
    output wire signed [16:0] sine, // s17.16  The sine of the carrier.
    output wire signed [16:0] window, // s17.16  The window.
    output reg [2:0] phase // u3.0  Polyphase: which of the carrier's five phases the sample has.
);

    reg [2:0] step; // u3.0  0 idle, 1 look_up, 2 wave, 3 cosine, 4 sine
    reg [8:0] window_phase; // u9.0
    reg [15:0] quarter [0:250]; // 251 words u16.16
    reg [15:0] quarter_word; // its read register

    wire phase_is_4 = phase == 3'd4; // u1.0
    wire signed [9:0] difference_36 = 10'd500 - {1'd0, window_phase}; // s10.0
    wire [3:0] sum_42 = {1'd0, phase} + 4'd1; // u4.0
    wire [9:0] sum_46 = {1'd0, window_phase} + 10'd1; // u10.0

    initial begin : initial_quarter
        quarter[0] = 16'h0000; quarter[1] = 16'h0003; quarter[2] = 16'h000a; quarter[3] = 16'h0017;
        quarter[4] = 16'h0028; quarter[5] = 16'h003f; quarter[6] = 16'h005b; quarter[7] = 16'h007c;
        quarter[8] = 16'h00a1; quarter[9] = 16'h00cc; quarter[10] = 16'h00fc; quarter[11] = 16'h0131;
        quarter[12] = 16'h016b; quarter[13] = 16'h01aa; quarter[14] = 16'h01ee; quarter[15] = 16'h0236;
        quarter[16] = 16'h0284; quarter[17] = 16'h02d7; quarter[18] = 16'h032e; quarter[19] = 16'h038b;
        quarter[20] = 16'h03ec; quarter[21] = 16'h0453; quarter[22] = 16'h04be; quarter[23] = 16'h052e;
        quarter[24] = 16'h05a3; quarter[25] = 16'h061d; quarter[26] = 16'h069b; quarter[27] = 16'h071f;
        quarter[28] = 16'h07a7; quarter[29] = 16'h0834; quarter[30] = 16'h08c5; quarter[31] = 16'h095c;
        quarter[32] = 16'h09f6; quarter[33] = 16'h0a96; quarter[34] = 16'h0b3a; quarter[35] = 16'h0be3;
        quarter[36] = 16'h0c90; quarter[37] = 16'h0d42; quarter[38] = 16'h0df9; quarter[39] = 16'h0eb4;
        quarter[40] = 16'h0f73; quarter[41] = 16'h1037; quarter[42] = 16'h10ff; quarter[43] = 16'h11cb;
        quarter[44] = 16'h129c; quarter[45] = 16'h1371; quarter[46] = 16'h144b; quarter[47] = 16'h1528;
        quarter[48] = 16'h160a; quarter[49] = 16'h16f0; quarter[50] = 16'h17da; quarter[51] = 16'h18c8;
        quarter[52] = 16'h19bb; quarter[53] = 16'h1ab1; quarter[54] = 16'h1bab; quarter[55] = 16'h1ca9;
        quarter[56] = 16'h1dab; quarter[57] = 16'h1eb1; quarter[58] = 16'h1fbb; quarter[59] = 16'h20c8;
        quarter[60] = 16'h21da; quarter[61] = 16'h22ef; quarter[62] = 16'h2407; quarter[63] = 16'h2523;
        quarter[64] = 16'h2643; quarter[65] = 16'h2766; quarter[66] = 16'h288d; quarter[67] = 16'h29b7;
        quarter[68] = 16'h2ae4; quarter[69] = 16'h2c15; quarter[70] = 16'h2d49; quarter[71] = 16'h2e80;
        quarter[72] = 16'h2fba; quarter[73] = 16'h30f8; quarter[74] = 16'h3238; quarter[75] = 16'h337c;
        quarter[76] = 16'h34c2; quarter[77] = 16'h360c; quarter[78] = 16'h3758; quarter[79] = 16'h38a7;
        quarter[80] = 16'h39f9; quarter[81] = 16'h3b4e; quarter[82] = 16'h3ca5; quarter[83] = 16'h3dff;
        quarter[84] = 16'h3f5b; quarter[85] = 16'h40ba; quarter[86] = 16'h421b; quarter[87] = 16'h437f;
        quarter[88] = 16'h44e5; quarter[89] = 16'h464d; quarter[90] = 16'h47b8; quarter[91] = 16'h4924;
        quarter[92] = 16'h4a93; quarter[93] = 16'h4c04; quarter[94] = 16'h4d76; quarter[95] = 16'h4eeb;
        quarter[96] = 16'h5061; quarter[97] = 16'h51da; quarter[98] = 16'h5354; quarter[99] = 16'h54cf;
        quarter[100] = 16'h564d; quarter[101] = 16'h57cc; quarter[102] = 16'h594c; quarter[103] = 16'h5ace;
        quarter[104] = 16'h5c51; quarter[105] = 16'h5dd6; quarter[106] = 16'h5f5b; quarter[107] = 16'h60e2;
        quarter[108] = 16'h626a; quarter[109] = 16'h63f4; quarter[110] = 16'h657e; quarter[111] = 16'h6709;
        quarter[112] = 16'h6895; quarter[113] = 16'h6a22; quarter[114] = 16'h6baf; quarter[115] = 16'h6d3e;
        quarter[116] = 16'h6ecd; quarter[117] = 16'h705c; quarter[118] = 16'h71ec; quarter[119] = 16'h737d;
        quarter[120] = 16'h750d; quarter[121] = 16'h769f; quarter[122] = 16'h7830; quarter[123] = 16'h79c2;
        quarter[124] = 16'h7b53; quarter[125] = 16'h7ce5; quarter[126] = 16'h7e77; quarter[127] = 16'h8008;
        quarter[128] = 16'h819a; quarter[129] = 16'h832b; quarter[130] = 16'h84bd; quarter[131] = 16'h864d;
        quarter[132] = 16'h87de; quarter[133] = 16'h896e; quarter[134] = 16'h8afd; quarter[135] = 16'h8c8c;
        quarter[136] = 16'h8e1b; quarter[137] = 16'h8fa8; quarter[138] = 16'h9135; quarter[139] = 16'h92c1;
        quarter[140] = 16'h944c; quarter[141] = 16'h95d6; quarter[142] = 16'h9760; quarter[143] = 16'h98e8;
        quarter[144] = 16'h9a6f; quarter[145] = 16'h9bf4; quarter[146] = 16'h9d79; quarter[147] = 16'h9efc;
        quarter[148] = 16'ha07e; quarter[149] = 16'ha1fe; quarter[150] = 16'ha37d; quarter[151] = 16'ha4fb;
        quarter[152] = 16'ha676; quarter[153] = 16'ha7f0; quarter[154] = 16'ha969; quarter[155] = 16'haadf;
        quarter[156] = 16'hac54; quarter[157] = 16'hadc6; quarter[158] = 16'haf37; quarter[159] = 16'hb0a6;
        quarter[160] = 16'hb212; quarter[161] = 16'hb37d; quarter[162] = 16'hb4e5; quarter[163] = 16'hb64b;
        quarter[164] = 16'hb7af; quarter[165] = 16'hb910; quarter[166] = 16'hba6f; quarter[167] = 16'hbbcb;
        quarter[168] = 16'hbd25; quarter[169] = 16'hbe7c; quarter[170] = 16'hbfd1; quarter[171] = 16'hc123;
        quarter[172] = 16'hc272; quarter[173] = 16'hc3be; quarter[174] = 16'hc508; quarter[175] = 16'hc64e;
        quarter[176] = 16'hc792; quarter[177] = 16'hc8d2; quarter[178] = 16'hca10; quarter[179] = 16'hcb4a;
        quarter[180] = 16'hcc81; quarter[181] = 16'hcdb5; quarter[182] = 16'hcee6; quarter[183] = 16'hd013;
        quarter[184] = 16'hd13d; quarter[185] = 16'hd264; quarter[186] = 16'hd387; quarter[187] = 16'hd4a7;
        quarter[188] = 16'hd5c3; quarter[189] = 16'hd6db; quarter[190] = 16'hd7f0; quarter[191] = 16'hd902;
        quarter[192] = 16'hda0f; quarter[193] = 16'hdb19; quarter[194] = 16'hdc1f; quarter[195] = 16'hdd21;
        quarter[196] = 16'hde1f; quarter[197] = 16'hdf19; quarter[198] = 16'he00f; quarter[199] = 16'he102;
        quarter[200] = 16'he1f0; quarter[201] = 16'he2da; quarter[202] = 16'he3c0; quarter[203] = 16'he4a2;
        quarter[204] = 16'he57f; quarter[205] = 16'he659; quarter[206] = 16'he72e; quarter[207] = 16'he7ff;
        quarter[208] = 16'he8cb; quarter[209] = 16'he993; quarter[210] = 16'hea57; quarter[211] = 16'heb16;
        quarter[212] = 16'hebd1; quarter[213] = 16'hec88; quarter[214] = 16'hed3a; quarter[215] = 16'hede7;
        quarter[216] = 16'hee90; quarter[217] = 16'hef34; quarter[218] = 16'hefd4; quarter[219] = 16'hf06e;
        quarter[220] = 16'hf105; quarter[221] = 16'hf196; quarter[222] = 16'hf223; quarter[223] = 16'hf2ab;
        quarter[224] = 16'hf32f; quarter[225] = 16'hf3ad; quarter[226] = 16'hf427; quarter[227] = 16'hf49c;
        quarter[228] = 16'hf50c; quarter[229] = 16'hf577; quarter[230] = 16'hf5de; quarter[231] = 16'hf63f;
        quarter[232] = 16'hf69c; quarter[233] = 16'hf6f3; quarter[234] = 16'hf746; quarter[235] = 16'hf794;
        quarter[236] = 16'hf7dc; quarter[237] = 16'hf820; quarter[238] = 16'hf85f; quarter[239] = 16'hf899;
        quarter[240] = 16'hf8ce; quarter[241] = 16'hf8fe; quarter[242] = 16'hf929; quarter[243] = 16'hf94e;
        quarter[244] = 16'hf96f; quarter[245] = 16'hf98b; quarter[246] = 16'hf9a2; quarter[247] = 16'hf9b3;
        quarter[248] = 16'hf9c0; quarter[249] = 16'hf9c7; quarter[250] = 16'hf9ca;
    end

    always @(posedge clock) begin
        quarter_word <= quarter[(window_phase < 9'd251) ? window_phase[7:0] : difference_36[7:0]];
    end

    always @(posedge clock) begin
        if (reset) begin
            step <= 3'd0;
            phase <= 3'd0;
            window_phase <= 9'd0;
            ready <= 1'd0;
        end else begin
            step <= {2'd0, sample ? 1'd1 : 1'd0};
            ready <= ~(step == 3'd0);
            if (sample) begin
                phase <= (restart | phase_is_4) ? 3'd0 : sum_42[2:0];
                window_phase <= (first | (window_phase == 9'd499)) ? 9'd0 : sum_46[8:0];
            end
        end
    end

    assign cosine = (phase == 3'd0) ? 17'd65535 : ((phase == 3'd1) | phase_is_4) ? 17'd20252 : 17'h130e4;
    assign sine = 17'd0;
    assign window = {1'd0, quarter_word};

    // What nothing needs.
    wire unused = &{1'b0, difference_36[9:8], sum_42[3], sum_46[9]};

endmodule

`default_nettype wire
