package skein.record

/** The tables of a recording as a page of the documentation. */
object RecordingSchema:

  /** Every table with its columns, types, and whether they may be absent. */
  def markdown: String =
    val tables = Table.all.map: table =>
      val columns = (Column("row", "BIGINT") +: table.columns.definitions).map: column =>
        s"| `${column.name}` | ${column.sqlType} | ${if column.nullable then "may be absent" else ""} |"
      s"## ${table.name}\n\n${meaning(table.name)}\n\n| column | type | |\n|---|---|---|\n${columns.mkString("\n")}\n"
    s"$introduction\n${tables.mkString("\n")}"

  private val introduction =
    """# What a recording contains
      |
      |A recording is one DuckDB file. Open it with any DuckDB client, or turn it into Parquet: `./skein export FILE --parquet DIR`, or look at it in [Foxglove](guides/foxglove.md): `./skein export FILE --mcap FILE`.
      |
      |Units are the ends of the names: `Ns` whole nanoseconds, `Ms` milliseconds, `M` metres, `Mps` metres per second, `Rad` radians, `RadPerS` radians per second. `North`, `East`, `Down` are the world frame; `Front`, `Right`, `Down` the body's. Columns that begin with `validAt` are on the simulator's clock, all other instants on the controller's. Every table begins with `row`, the order in which all rows of the flight were accepted.
      |
      |```sql
      |-- how old the data of each vehicle's decisions was, by the simulator's clock
      |SELECT vehicle, avg(ownTrueAgeMs), quantile_cont(ownTrueAgeMs, 0.99) FROM decision GROUP BY vehicle;
      |```
      |""".stripMargin

  private def meaning(table: String): String = table match
    case "flight"    => "What was flown: one row."
    case "parameter" => "Run parameters without a column in `flight`."
    case "vehicle"   => "One row a vehicle; `start…` is the origin of its own frame in the world frame."
    case "reading"   => "One row an answer of the simulator."
    case "decision"  =>
      "One row a decision, with the readings it was made from. `own…Age` counts from arrival, as the paper published it; `ownTrueAge` from the valid time."
    case "sighting"    => "The readings of the other vehicles that a decision for a team was made from."
    case "measurement" => "One row an answer of a sensor; `quantities` names its numbers, with their units."
    case "sensing"     =>
      "The measurements that a decision was made from: one row for each sensor that its policy reads."
    case "plan"            => "How a decision was planned."
    case "prediction"      => "Predictions whose moment was read, with their error."
    case "command"         => "One row a command as it was sent."
    case "acknowledgement" => "How each command ended."
    case "latency"         => "Round trips over the link."
    case "event"           => "What the loop did not want: every drop, skip, time-out, reconnect."
    case "truth"           => "Where vehicles were, where that is sampled apart from the readings."
    case "ending"          => "How the flight ended: one row, none where the recording broke off before."
    case other             => throw IllegalArgumentException(s"table $other has no description")
