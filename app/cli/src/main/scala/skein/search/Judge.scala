package skein.search

/** What judges candidates in the course of a search. */
enum Judge:
  /** Many candidates on the same episodes. */
  case Candidates

  /** What was found, alone on episodes that are fresh. */
  case Winner

  /** What it is held against, alone. */
  case Baseline
