package skein.report

import skein.measure.{Distribution, PredictionGroup}
import skein.units.Decimals.{brief, fixed}

/** Errors of predictions, as a table. */
object PredictionTable:

  def of(groups: Vector[PredictionGroup]): TextTable =
    val isSeveral = groups.exists(_.scenario.nonEmpty)
    TextTable(
      Option.when(isSeveral)("<scenario").toVector ++ Vector(
        "<loop",
        "<link",
        "<of",
        "made",
        "unverified",
        "carried by ms",
        "p50 mm",
        "p95 mm",
        "p95 at 100 ms, mm"
      ),
      for
        group           <- groups
        (whose, errors) <- Vector("own vehicle" -> group.own, "others" -> group.others)
        if errors.made > 0
      yield Option.when(isSeveral)(group.scenario).toVector ++
        Vector(group.name, group.link, whose, errors.made.toString, errors.unverified.toString) ++ Vector(
          Distribution.of(errors.samples.map(_._1)).map(_.median).fold("")(_.brief),
          errors.errors.fold("")(all => (1000 * all.median).fixed(1)),
          errors.errors.fold("")(all => (1000 * all.quantile(0.95)).fixed(1)),
          errors.around(100).fold("")(all => (1000 * all.quantile(0.95)).fixed(1))
        )
    )
