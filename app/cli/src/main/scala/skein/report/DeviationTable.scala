package skein.report

import skein.measure.Deviation
import skein.units.Decimals.{fixed, signed}

/** Deviations of the loops from the paused flight, as a table. */
object DeviationTable:

  def of(deviations: Vector[Deviation]): TextTable =
    val isSeveral = deviations.exists(_.scenario.nonEmpty)
    TextTable(
      Option.when(isSeveral)("<scenario").toVector ++
        Vector("<loop", "<link", "<clock", "flights", "mean %", "sd %", "least %", "most %"),
      deviations.map: one =>
        def percent(share: Double) = (100 * share).signed(1)
        Option.when(isSeveral)(one.scenario).toVector ++ Vector(
          one.name,
          one.link,
          one.clock,
          one.share.count.toString,
          percent(one.share.mean),
          if one.share.count == 1 then "" else (100 * one.share.sampleSd).fixed(1),
          percent(one.share.least),
          percent(one.share.most)
        )
    )
