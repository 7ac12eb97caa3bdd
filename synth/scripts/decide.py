# SPDX-License-Identifier: MIT OR Apache-2.0
"""Decides bit-vector problems (SMT-LIB 2 up to `check-sat`) with a solver that PyPI has as a library only.

    decide bitwuzla|cvc5 FILE...

A line `unsat` or `sat` for each file; after `sat` a line `NAME BITS` for every declared bit vector of the counterexample.
"""

import sys


def bitwuzla(path):
    import bitwuzla as library

    options = library.Options()
    options.set(library.Option.PRODUCE_MODELS, True)
    parser = library.Parser(library.TermManager(), options)
    parser.parse(path, True)
    solver = parser.bitwuzla()
    answer = solver.check_sat()
    if answer == library.Result.UNSAT:
        return "unsat", []
    if answer != library.Result.SAT:
        return "unknown", []
    signals = [term for term in parser.get_declared_funs() if term.sort().is_bv()]
    return "sat", [(term.symbol(), solver.get_value(term).value(2)) for term in signals]


def cvc5(path):
    import cvc5 as library

    terms = library.TermManager()
    solver = library.Solver(terms)
    solver.setOption("produce-models", "true")
    parser = library.InputParser(solver)
    parser.setFileInput(library.InputLanguage.SMT_LIB_2_6, path)
    symbols = parser.getSymbolManager()
    answer = "unknown"
    while not (command := parser.nextCommand()).isNull():
        answer = command.invoke(solver, symbols).strip() or answer
    if answer != "sat":
        return answer, []
    signals = [term for term in symbols.getDeclaredTerms() if term.getSort().isBitVector()]
    return "sat", [(term.getSymbol(), solver.getValue(term).getBitVectorValue(2)) for term in signals]


def main(solver, *paths):
    for path in paths:
        answer, signals = {"bitwuzla": bitwuzla, "cvc5": cvc5}[solver](path)
        print(answer)
        for name, bits in signals:
            print(name.strip("|"), bits)


if __name__ == "__main__":
    main(*sys.argv[1:])
