package skein.search

import skein.optimise.ValueEvaluator
import skein.policy.SearchSpace

/** What judges candidates in the course of a search. */
enum Judge:
  /** Many candidates on the same episodes. */
  case Candidates

  /** What was found, alone on episodes that are fresh. */
  case Winner

  /** The paper's policy of the same role, alone. */
  case Paper

/** A search whose question was read: whoever reads the same question judges with the same bits. */
trait ReadySearch:
  def space: SearchSpace

  /** What judges in this process, one call at a time. */
  def judges(threads: Int): Judge => ValueEvaluator
