package skein.report

import skein.measure.{Deviation, Numbers}

/** How far from the paused truth the loops ended, as a table. */
object DeviationTable:

  def of(deviations: Vector[Deviation]): TextTable =
    TextTable(
      Vector("<loop", "<link", "<clock", "flights", "mean %", "sd %", "least %", "most %"),
      deviations.map: one =>
        def percent(share: Double) = Numbers.signed(100 * share)
        Vector(
          one.name,
          one.link,
          one.clock,
          one.share.count.toString,
          percent(one.share.mean),
          if one.share.count == 1 then "" else Numbers.fixed(100 * one.share.sd, 1),
          percent(one.share.least),
          percent(one.share.most)
        )
    )
