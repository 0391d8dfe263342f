package skein.search

/** The candidates that an evaluator scores in the course of a search. */
enum Judge:
  /** Many candidates, all on equal episodes. */
  case Candidates

  /** The best candidate, alone on fresh episodes. */
  case Winner

  /** The baseline, alone on these fresh episodes. */
  case Baseline
