// SPDX-License-Identifier: MIT OR Apache-2.0
// Divider: the quotient is the correctly rounded one, for all operands; it comes when it should.
//
// Stands at the end of the printed module, after the widths N, D, Q of numerator, denominator and quotient, PAD (the zeros
// behind the numerator) and LATENCY. The product of partial quotient and denominator is kept by shifting and adding, as the
// solver cannot multiply words of this length; `divider_small` has the product itself.

    localparam W = N + PAD > Q + 1 ? N + PAD : Q + 1;

    reg [N-1:0] given_numerator;
    reg [D-1:0] given_denominator;
    reg [Q+D-1:0] product;
    reg [7:0] age;
    reg was_reset = 0;
    reg pending = 0;
    always @(posedge clock) begin
        was_reset <= 1;
        pending <= !reset && (start || (pending && !done));
        age <= age + 1;
        if (start) begin
            given_numerator <= numerator;
            given_denominator <= denominator;
            product <= 0;
            age <= 1;
        end else if (busy && count != Q) begin
            product <= {product, 1'b0} + (bit_fits ? {{Q{1'b0}}, given_denominator} : 0);
        end
    end
    // The digit that this clock finds: the reference's own comparison.
    wire bit_fits = {remainder, tail[Q-1]} >= given_denominator;

    wire [W-1:0] dividend = {{W{1'b0}}, given_numerator} << PAD;
    wire [W-1:0] taken = dividend >> (Q - count);
    wire [Q-1:0] still = dividend[Q-1:0] << count;
    wire too_large = (dividend >> Q) >= given_denominator;

    // The contract of the caller.
    always @(*) if (busy) assume (numerator == given_numerator && denominator == given_denominator);
    always @(*) if (!was_reset) assume (reset); else assume (!reset);

    always @(posedge clock) if (was_reset) begin
        // What holds all along.
        assert (count <= Q || !busy);
        assert (!(busy && done));
        if (busy) assert (age == count + 1);
`ifdef KEEPS
        if (busy) assert (denominator_q == given_denominator);
`endif
        if (busy || done) begin
            assert (over == too_large);
            assert (partial >> count == 0);
            if (done) assert (count == Q);
            if (!over) begin
                assert (taken == product + remainder);
                assert (remainder < given_denominator);
                assert (tail == still);
`ifdef SMALL
                assert (product == partial * given_denominator);
`endif
            end
        end
        // An answer is under way for what was asked, and for nothing else.
        assert (pending == (busy || done));
        // What is claimed.
        if (done) begin
            assert (age == LATENCY);
            if (too_large) begin
                assert (saturated && &quotient);
            end else if (saturated) begin
                // Rounded up past the rail.
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
