// SPDX-License-Identifier: MIT OR Apache-2.0
// Divider: the quotient is correctly rounded for all operands, with the stated latency.
//
// Appended to the printed module; parameters: the widths N, D, Q of numerator, denominator and quotient, PAD (the zeros
// behind the numerator) and LATENCY. The product of partial quotient and denominator is kept by shifting and adding, as the
// solver cannot multiply words of this length; with SMALL, where it can, the product itself is looked at too.

    localparam W = N + PAD > Q + 1 ? N + PAD : Q + 1;

    reg [N-1:0] given_numerator;
    reg [D-1:0] given_denominator;
    reg [Q-1:0] partial;
    reg [Q+D-1:0] product;
    reg [7:0] age;
    reg was_reset = 0;
    reg pending = 0;
    // Count 0 checks that the quotient fits, each of the next Q finds a digit, then come rounding and the result.
    wire finds = count != 0 && count <= Q;
    wire [7:0] found = count == 0 ? 0 : count > Q ? Q : count - 1;
    // The digit that this clock finds: the reference's own comparison.
    wire digit = {remainder, tail[Q-1]} >= given_denominator;
    always @(posedge clock) begin
        was_reset <= 1;
        pending <= !reset && (start || (pending && !done));
        age <= age + 1;
        if (start) begin
            given_numerator <= numerator;
            given_denominator <= denominator;
            partial <= 0;
            product <= 0;
            age <= 1;
        end else if (busy && finds) begin
            partial <= {partial, digit};
            product <= {product, 1'b0} + (digit ? {{Q{1'b0}}, given_denominator} : 0);
        end
    end

    wire [W-1:0] dividend = {{W{1'b0}}, given_numerator} << PAD;
    wire [W-1:0] taken = dividend >> (Q - found);
    wire [Q-1:0] still = dividend[Q-1:0] << found;
    wire overflows = (dividend >> Q) >= given_denominator;
    wire [D+1:0] twice = 2 * remainder;

    // Assumptions about the caller.
    always @(*) if (busy) assume (numerator == given_numerator && denominator == given_denominator);
    always @(*) if (!was_reset) assume (reset); else assume (!reset);

    always @(posedge clock) if (was_reset) begin
        // Invariants.
        assert (count <= Q + 2 || !busy);
        assert (!(busy && done));
        if (busy) assert (age == count + 1);
        if (busy || done) begin
            if (count != 0) assert (over == overflows);
            if (done) assert (count == Q + 2);
            if (count == 0 || !over) begin
                assert (partial >> found == 0);
                assert (taken == product + remainder);
                assert (tail == (still | partial));
                if (count != 0) assert (remainder < given_denominator);
                if (count == Q + 2)
                    assert (up == (twice > given_denominator || (twice == given_denominator && partial[0])));
`ifdef SMALL
                assert (product == partial * given_denominator);
`endif
            end
        end
        // A result is in progress if and only if one was requested.
        assert (pending == (busy || done));
        // Properties.
        if (done) begin
            assert (age == LATENCY);
            if (overflows) begin
                assert (saturated && &quotient);
            end else if (saturated) begin
                // Rounded up beyond full scale.
                assert (&quotient && &partial && 2 * (dividend - product) >= given_denominator);
            end else begin
                assert (quotient == partial || (quotient == partial + 1'b1 && !(&partial)));
                // |dividend - quotient * denominator| is at most half the denominator, and if it is half, the quotient is even.
                if (quotient == partial) begin
                    assert (2 * {2'd0, dividend - product} <= given_denominator);
                    assert (2 * {2'd0, dividend - product} < given_denominator || !quotient[0]);
                end else begin
                    assert (2 * {2'd0, dividend - product} >= given_denominator);
                    assert (2 * {2'd0, dividend - product} > given_denominator || !quotient[0]);
                end
            end
        end
    end
