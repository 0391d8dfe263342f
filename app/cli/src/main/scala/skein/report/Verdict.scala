package skein.report

import skein.measure.Deviation
import skein.record.{ClockKind, LoopKind}
import skein.units.Decimals.fixed

/** The result of the flights, in a sentence for each link: each loop's deviation from the paused flight. */
object Verdict:

  /** One sentence per scenario, link and clock with several loops that used the paper's policies, live
    * flights last, and the link with the largest deviation last among them; empty without a paused flight.
    * The loop `plan` is left out, since it decides otherwise and may do better.
    */
  def sentences(deviations: Seq[Deviation]): Vector[String] =
    val groups = deviations.toVector
      .filterNot(_.loop == LoopKind.Plan.label)
      .groupBy(one => (one.scenario, one.link, one.clock))
      .toVector
      .filter(_._2.sizeIs > 1)
    def isVirtual(clock: String) = clock == ClockKind.Virtual.label
    groups
      .sortBy((key, group) => (!isVirtual(key._3), group.map(_.share.mean.abs).max))
      .map: (key, group) =>
        val (scenario, link, clock) = key
        val shares                  = group
          .sortBy(-_.share.mean.abs)
          .map(one => s"${one.name} ${(100 * one.share.mean.abs).fixed(1)} %")
        val flown = if isVirtual(clock) then " in virtual time" else ""
        val task  = if scenario.isEmpty then "" else s", $scenario"
        s"Over $link$flown$task, off the truth by: ${shares.mkString(", ")}."
