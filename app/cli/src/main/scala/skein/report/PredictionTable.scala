package skein.report

import skein.measure.{Distribution, PredictionErrors, PredictionGroup}
import skein.units.Decimals.{brief, fixed}

/** Errors of predictions, as a table. */
object PredictionTable:

  def of(groups: Vector[PredictionGroup]): TextTable =
    val rows =
      for
        group           <- groups
        (whose, errors) <- Vector("own vehicle" -> group.own, "others" -> group.others)
        if errors.made > 0
      yield (group = group, whose = whose, errors = errors)
    TextTable.of(rows)(columns.drop(if groups.exists(_.scenario.nonEmpty) then 0 else 1)*)

  private type Row = (group: PredictionGroup, whose: String, errors: PredictionErrors)

  private val columns = Vector[TextTable.Column[Row]](
    "<scenario"         -> (_.group.scenario),
    "<loop"             -> (_.group.name),
    "<link"             -> (_.group.link),
    "<of"               -> (_.whose),
    "made"              -> (_.errors.made.toString),
    "unverified"        -> (_.errors.unverified.toString),
    "carried by ms"     -> (row => Distribution.of(row.errors.samples.map(_._1)).fold("")(_.median.brief)),
    "p50 mm"            -> (row => mm(row.errors.errors, 0.5)),
    "p95 mm"            -> (row => mm(row.errors.errors, 0.95)),
    "p95 at 100 ms, mm" -> (row => mm(row.errors.around(100), 0.95))
  )

  private def mm(errorsM: Option[Distribution], p: Double) =
    errorsM.fold("")(all => (1000 * all.quantile(p)).fixed(1))
