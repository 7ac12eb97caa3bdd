// SPDX-License-Identifier: MIT OR Apache-2.0
// Square root: correctly rounded for all radicands, with the stated latency.
//
// Appended to the printed module; parameters: R (the radicand's width), DIGITS, PAD (the zeros behind the radicand) and
// LATENCY. The square of the partial root is maintained by shifting and adding: (2p + b)² = 4p² + b(4p + 1).

    localparam W = 2 * DIGITS;

    reg [R-1:0] given;
    reg [W-1:0] square;
    reg [7:0] age;
    reg was_reset = 0;
    reg pending = 0;
    wire digit = {remainder, tail[W-1:W-2]} >= {partial, 2'b01};
    always @(posedge clock) begin
        was_reset <= 1;
        pending <= !reset && (start || (pending && !done));
        age <= age + 1;
        if (start) begin
            given <= radicand;
            square <= 0;
            age <= 1;
        end else if (busy && count != DIGITS) begin
            square <= {square, 2'b00} + (digit ? {partial, 2'b01} : 0);
        end
    end

    wire [W-1:0] whole = {{W{1'b0}}, given} << PAD;
    wire [W-1:0] taken = whole >> 2 * (DIGITS - count);
    wire [W-1:0] still = whole << 2 * count;

    always @(*) if (!was_reset) assume (reset); else assume (!reset);

    always @(posedge clock) if (was_reset) begin
        // Invariants.
        assert (count <= DIGITS || !busy);
        assert (!(busy && done));
        if (busy) assert (age == count + 1);
        if (busy || done) begin
            assert (partial >> count == 0);
            if (done) assert (count == DIGITS);
            assert (taken == square + remainder);
            assert (remainder <= {partial, 1'b0});
            assert (tail == still);
`ifdef SMALL
            assert (square == partial * partial);
`endif
        end
        // A result is in progress if and only if one was requested.
        assert (pending == (busy || done));
        // Properties: root − ½ < √whole < root + ½, that is root² − root < whole ≤ root² + root.
        if (done) begin
            assert (age == LATENCY);
            assert (sqrt == partial || sqrt == partial + 1'b1);
            if (sqrt == {1'b0, partial}) assert (whole - square <= partial);
            else assert (whole - square > partial && whole - square <= {partial, 1'b0});
        end
    end
