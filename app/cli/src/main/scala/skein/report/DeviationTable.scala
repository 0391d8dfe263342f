package skein.report

import skein.measure.{Deviation, Distribution}
import skein.units.Decimals.{fixed, signed}

/** Deviations of the loops from the paused flight, as a table. */
object DeviationTable:

  def of(deviations: Vector[Deviation]): TextTable =
    TextTable.of(deviations)(columns.drop(if deviations.exists(_.scenario.nonEmpty) then 0 else 1)*)

  private val columns = Vector[TextTable.Column[Deviation]](
    "<scenario" -> (_.scenario),
    "<loop"     -> (_.name),
    "<link"     -> (_.link),
    "<clock"    -> (_.clock),
    "flights"   -> (_.share.count.toString),
    "mean %"    -> percent(_.mean),
    "sd %"      -> (one => if one.share.count == 1 then "" else (100 * one.share.sampleSd).fixed(1)),
    "least %"   -> percent(_.least),
    "most %"    -> percent(_.most)
  )

  private def percent(of: Distribution => Double)(one: Deviation) = (100 * of(one.share)).signed(1)
