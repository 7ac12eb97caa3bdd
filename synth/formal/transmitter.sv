// SPDX-License-Identifier: MIT OR Apache-2.0
// Transmitter: a byte that is taken is on the line as ten bits of DIVISOR clocks each, and no other is taken before.
//
// Appended to the printed module; parameters: DIVISOR.

    reg was_reset = 0;
    always @(posedge clock) was_reset <= 1;
    always @(*) if (!was_reset) assume (reset);

    // Start, bits, stop; how many clocks of which bit have gone by.
    reg [7:0] sent = 0;
    wire [9:0] line = {1'b1, sent, 1'b0};
    reg [3:0] bits = 10;
    reg [31:0] gone = 0;
    wire [23:0] shifted = {16'hffff, line[8:1]} >> bits;
    wire last = gone == DIVISOR - 1;
    always @(posedge clock) begin
        if (reset) bits <= 10;
        else if (taken) begin
            sent <= octet;
            bits <= 0;
            gone <= 0;
        end else if (bits != 10) begin
            bits <= bits + last;
            gone <= last ? 0 : gone + 1;
        end
    end

    always @(posedge clock) if (was_reset) begin
        // Invariants.
        assert (bits <= 10 && gone < DIVISOR);
        assert (busy == (bits != 10));
        if (busy) assert (position == bits && count == DIVISOR - 1 - gone);
        if (busy) assert (octet_q == shifted[7:0]);
        // Properties.
        assert (tx == (bits == 10 || line[bits]));
        assert (taken == (valid && bits == 10));
        assert (ending == (bits == 9 && last));
        cover (bits == 1 && sent == 8'b10100101);
    end
