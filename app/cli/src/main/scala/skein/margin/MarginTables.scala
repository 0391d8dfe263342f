package skein.margin

import skein.report.{Section, TextTable}
import skein.units.Decimals.{brief, counted, fixed, signed}
import skein.units.Interval

/** A margin as tables and sentences, for people and for scripts. */
object MarginTables:

  /** @param hasLimits whether violations can be counted */
  def of(curve: MarginCurve, hasLimits: Boolean): Vector[Section] =
    Vector(links(curve, hasLimits), margin(curve)) ++ without(curve)

  private def links(curve: MarginCurve, hasLimits: Boolean) =
    val judge          = curve.judge
    val (factor, unit) = curve.tolerance.shown(judge.unit)
    val limits         = Option.when(hasLimits)("violations").toVector
    Section(
      "Over each link",
      "The mean is of its runs, with its 95 % interval; calls that read states took so long in the middle, " +
        "and so old was a vehicle's own data on average when it was commanded.",
      Some(TextTable(
        Vector(
          "<link",
          "round trip ms",
          "calls ms",
          "data ms",
          s"mean of ${judge.name} ${judge.unit}".trim
        ) ++
          Vector(s"off $unit".trim) ++ limits ++ Vector("runs", "without result"),
        (curve.reference +: curve.points).map: point =>
          val stats = point.stats
          val half  = stats.halfWidth95
          val mean  =
            if stats.count == 0 then ""
            else if half.isInfinite then stats.mean.brief
            else Interval.of(stats.mean, half).text
          val off = curve.deviation(point) * factor
          Vector(
            point.link.name,
            point.meanMs.fixed(1),
            middle(point.runs.flatMap(_.callMs)),
            middle(point.runs.flatMap(_.ageMs)),
            mean,
            if point.eq(curve.reference) || off.isNaN then "" else off.signed(1)
          ) ++ limits.map(_ => point.violations.toString) ++
            Vector(stats.count.toString, point.without.size.toString)
      ))
    )

  private def margin(curve: MarginCurve) = Section(
    "Margin",
    "",
    Some(TextTable(
      Vector("<measure", "<tolerance", "<holds up to", "<from", "<to"),
      Vector(Vector(
        curve.judge.name,
        curve.tolerance.text(curve.judge.unit),
        MarginCurve.text(curve.margin),
        MarginCurve.text(curve.interval.from),
        MarginCurve.text(curve.interval.to)
      ))
    ))
  )

  private def without(curve: MarginCurve): Option[Section] =
    val rows =
      for
        point          <- curve.reference +: curve.points
        (why, reasons) <- point.without.groupBy(_.why).toVector.sortBy(_._1)
      yield Vector(point.link.name, reasons.size.toString, why)
    Option.when(rows.nonEmpty)(
      Section("Runs without a result", "", Some(TextTable(Vector("<link", "runs", "<why"), rows)))
    )

  /** The basis of a margin and its limits, a paragraph each. */
  def remarks(curve: MarginCurve, atOnce: Int): Vector[String] =
    val all     = (curve.reference +: curve.points).flatMap(_.runs)
    val starved = all.count(_.value match
      case Left(MarginRun.NoResult.OfMachine(_)) => true
      case _                                     => false)
    Vector(
      s"${counted(all.size, "run")} by the clock, ${MarginTables.atOnce(atOnce)}. What is compared is the " +
        "program without an emulated link: its own pauses, its language and its client are in that already, " +
        "and what they cost cannot be told from here."
    ) ++ Option.when(starved > 0):
      s"Not counted, for the machine was too busy or they could not begin: $starved of " +
        s"${counted(all.size, "run")}. Others may have been slowed by less than can be told; let nothing else " +
        "run meanwhile."
    ++ Option.when(curve.reference.stats.count < 2):
      "One run says nothing about chance: more --repeats give intervals."

  def atOnce(count: Int): String = if count == 1 then "one at a time" else s"$count at once"

  private def middle(values: Vector[Double]) =
    if values.isEmpty then "" else values.sorted.apply(values.size / 2).fixed(1)
