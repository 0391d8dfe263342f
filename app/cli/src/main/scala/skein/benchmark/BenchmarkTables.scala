package skein.benchmark

import skein.report.{Section, TextTable}
import skein.units.Decimals.{fixed, signed}

/** The result of a benchmark for people and, as JSON, for scripts: two tables. */
object BenchmarkTables:

  /** Two tables: a row for each entry over all its cells, and one for each cell of each entry. */
  def of(rows: Vector[BenchmarkRow]): Vector[Section] = Vector(
    Section(
      s"Entries, benchmark ${BenchmarkSet.Version}",
      "Off the truth: by how much the scenario's first measure deviates from that of flights by `paused` in " +
        "the same world. Violations: of the scenario's limits, a flight, beyond those of `paused`.",
      Some(entries(rows))
    ),
    Section(
      "Cells",
      "± is half of the 95 % interval over seeds, those of the paused loop included.",
      Some(cells(rows))
    )
  )

  private def entries(rows: Vector[BenchmarkRow]) = TextTable(
    Vector("<entry", "mean |off| %", "worst %", "<where", "within 5 %", "of", "violations"),
    rows.map(_.entry).distinct.map: entry =>
      val own   = rows.filter(_.entry == entry)
      val off   = own.flatMap(row => row.meanOff.map(row -> _.abs))
      val worst = off.maxByOption(_._2)
      Vector(
        entry.name,
        if off.isEmpty then "" else (100 * off.map(_._2).sum / off.size).fixed(1),
        worst.fold("")(found => (100 * found._2).fixed(1)),
        worst.fold("")((row, _) => s"${row.cell.task.name}, ${row.cell.world.name}, ${row.cell.link}"),
        off.count(_._2 <= 0.05).toString,
        off.size.toString,
        (own.map(_.violations).sum / own.size).fixed(2)
      )
  )

  private def cells(rows: Vector[BenchmarkRow]) = TextTable.of(rows)(
    "<task"        -> (_.cell.task.name),
    "<world"       -> (_.cell.world.name),
    "<link"        -> (_.cell.link),
    "<entry"       -> (_.entry.name),
    "flights"      -> (_.flights.size.toString),
    "truth"        -> (_.truth.fold("")(_.fixed(3))),
    "off %"        -> (_.meanOff.fold("")(off => (100 * off).signed(1))),
    "±"            -> (_.halfOff.fold("")(half => (100 * half).fixed(1))),
    "violations"   -> (_.violations.fixed(2)),
    "age ms"       -> (_.ageMs.fold("")(_.fixed(0))),
    "error p95 mm" -> (_.errorP95M.fold("")(error => (1000 * error).fixed(1))),
    "<not flown"   -> (_.notFlown.headOption.getOrElse(""))
  )
