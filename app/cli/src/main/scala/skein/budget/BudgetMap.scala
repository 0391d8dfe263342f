package skein.budget

import skein.lanes.Engine
import skein.optimise.LatencyBudget.Bound
import skein.optimise.{LatencyBudget, RunningStats}
import skein.search.SearchResult
import skein.signal.LatencyDistribution
import skein.units.Decimals.{fixed, signed, significant}

/** A map of one loop at one period, with its labels.
  *
  * @param engine the engine that simulated it
  * @param marks named links, with the results over their measured round trips
  */
final case class BudgetMap(
    task: BudgetTask,
    engine: Engine,
    tolerance: Tolerance,
    episodes: Int,
    budget: LatencyBudget,
    marks: Vector[BudgetMark],
    legs: Legs
):
  import task.{formula, loop, periodMs, unit}

  /** One sentence on how much latency the policy tolerates, from the row of cells nearest to a jitter. */
  def sentence(atJitterMs: Double): String =
    val row    = budget.jittersMs.indices.minBy(i => (budget.jittersMs(i) - atJitterMs).abs)
    val jitter = s"${ms(budget.jittersMs(row))} ms jitter"
    val truth  = s"the truth, ${budget.truth.significant(4)}${if unit.isEmpty then "" else s" $unit"},"
    val within = s"within ${tolerance.text(unit)} of $truth"
    val end    = s"(${legs.text}; $loop every ${periodMs.significant(4)} ms)"
    budget.holdsUpTo(row, tolerance.value) match
      case Bound.At(mean)     => s"holds $within up to ${ms(mean)} ms mean at $jitter $end"
      case Bound.Beyond(mean) => s"holds $within as far as the map goes, ${ms(mean)} ms mean, at $jitter $end"
      case Bound.Below(mean)  => s"does not hold $within even at ${ms(mean)} ms mean and $jitter $end"
      case Bound.Unknown      => s"no link of the map has $jitter $end"

  def markLines: Vector[String] = marks.map: mark =>
    val (factor, offUnit)                = tolerance.shown(unit)
    val off                              = factor * (mark.tally.mean - budget.truth) / budget.per
    def told(text: String, unit: String) = s"$text $unit".trim
    val came                             =
      if !off.isFinite then s"$formula has no value"
      else
        s"$formula = ${SearchResult.interval(mark.tally, unit)}, ${told(off.signed(1), offUnit)} off the truth"
    val where = if isOnMap(mark) then ""
    else
      s"; not drawn: the map ends before it, at ${ms(budget.meansMs.last)} " +
        s"and ${ms(budget.jittersMs.last)} ms"
    f"${mark.name}%-8s mean ${ms(mark.roundTrip.mean.toMillis)} ms, jitter ${ms(mark.roundTrip.jitter.toMillis)} ms: " +
      came + where

  def isOnMap(mark: BudgetMark): Boolean =
    mark.roundTrip.mean.toMillis <= budget.meansMs.last && mark.roundTrip.jitter.toMillis <= budget.jittersMs.last

  def csvRows: Vector[String] = cells.map: cell =>
    import cell.*
    Vector(periodMs, meanMs, jitterMs, tally.mean, tally.sd, tally.count, deviation).mkString(",")

  private def cells: Vector[BudgetMap.Cell] =
    for
      (jitter, i) <- budget.jittersMs.zipWithIndex
      (mean, j)   <- budget.meansMs.zipWithIndex
      tally       <- budget.cells(i)(j).toVector
    yield BudgetMap.Cell(
      mean / legs.perRoundTrip,
      jitter / legs.perRoundTrip,
      tally,
      budget.deviation(i, j).get
    )

  private def ms(roundTripMs: Double): String =
    (roundTripMs / legs.perRoundTrip).fixed(0)

/** A named link, with the policy's result over it. */
final case class BudgetMark(name: String, roundTrip: LatencyDistribution, tally: RunningStats)

/** The unit in which latencies are stated: the whole round trip, or one direction. */
enum Legs(val text: String, val perRoundTrip: Double):
  case RoundTrip extends Legs("round trips", 1)
  case OneWay    extends Legs("one way", 2)

object BudgetMap:
  val CsvHeader = "periodMs,meanMs,jitterMs,objective,sd,episodes,deviation"

  /** All maps as JSON, in ASCII: the question, and for each map its sentence, the paused loop's value and the
    * cells.
    */
  def json(maps: Vector[BudgetMap], atJitterMs: Double): String =
    ujson.write(maps.map(shown(_, atJitterMs)), indent = 1, escapeUnicode = true)

  private def shown(map: BudgetMap, atJitterMs: Double) =
    import map.{task, tolerance}
    ujson.Obj(
      "sentence"  -> map.sentence(atJitterMs),
      "policy"    -> task.label,
      "loop"      -> task.loop,
      "periodMs"  -> task.periodMs,
      "vehicles"  -> task.vehicles,
      "engine"    -> map.engine.text,
      "objective" -> task.formula,
      "unit"      -> task.unit,
      "latencies" -> map.legs.text,
      "jitter"    -> "p99 - p50",
      "tolerance" -> tolerance.value,
      "deviation" -> (tolerance match
        case Tolerance.Share(_)  => "share of the truth"
        case Tolerance.Within(_) => "distance from the truth"),
      "truth"           -> map.budget.truth,
      "episodesPerCell" -> map.episodes,
      "cells"           -> map.cells.map(cell =>
        ujson.Obj(
          "meanMs"    -> cell.meanMs,
          "jitterMs"  -> cell.jitterMs,
          "objective" -> cell.tally.mean,
          "sd"        -> cell.tally.sd,
          "deviation" -> cell.deviation
        )
      )
    )

  private final case class Cell(meanMs: Double, jitterMs: Double, tally: RunningStats, deviation: Double)
