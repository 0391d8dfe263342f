package skein.report

import skein.measure.{Distribution, Numbers, PredictionGroup}

/** How far predictions were off, as a table. */
object PredictionTable:

  def of(groups: Vector[PredictionGroup]): TextTable =
    TextTable(
      Vector(
        "<loop",
        "<link",
        "<of",
        "made",
        "unverified",
        "age ms",
        "p50 mm",
        "p95 mm",
        "p95 at 100 ms, mm"
      ),
      for
        group           <- groups
        (whose, errors) <- Vector("own vehicle" -> group.own, "others" -> group.others)
        if errors.made > 0
      yield Vector(group.name, group.link, whose, errors.made.toString, errors.unverified.toString) ++ Vector(
        Distribution.of(errors.samples.map(_._1)).map(_.median).fold("")(Numbers.brief),
        errors.errors.fold("")(all => Numbers.fixed(1000 * all.median, 1)),
        errors.errors.fold("")(all => Numbers.fixed(1000 * all.quantile(0.95), 1)),
        errors.around(100).fold("")(all => Numbers.fixed(1000 * all.quantile(0.95), 1))
      )
    )
