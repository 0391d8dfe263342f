package skein.search

import skein.optimise.RunningStats
import skein.report.{Section, TextTable}

/** What a search found beside what there was before, as a table. */
private[search] object SearchTable:

  /** @param rows
    *   a name, parameters with their values, and what they came to on fresh episodes
    */
  def of(formula: String, unit: String)(rows: (String, Seq[(String, Double)], RunningStats)*): Section =
    Section(
      s"$formula, on fresh episodes",
      table = Some(TextTable(
        Vector("<policy", "<parameters", "mean", "± 95 %", "episodes", "<unit"),
        rows.toVector.map((name, parameters, tally) =>
          Vector(
            name,
            parameters.map((parameter, value) => s"$parameter = $value").mkString(", "),
            tally.mean.toString,
            tally.halfWidth95.toString,
            tally.count.toString,
            unit
          )
        )
      ))
    )
