package skein.record

/** The tables of a recording as a page of the documentation. */
object RecordingSchema:

  /** Every table with its columns, types, and whether they may be absent. */
  def markdown: String =
    val tables = Table.all.map: table =>
      val columns = table.numbered.map: column =>
        s"| `${column.name}` | ${column.sqlType} | ${if column.nullable then "may be absent" else ""} |"
      s"## ${table.name}\n\n${meaning(table.name)}\n\n| column | " +
        s"type | |\n|---|---|---|\n${columns.mkString("\n")}\n"
    s"$introduction\n${tables.mkString("\n")}"

  private val introduction =
    """# What a recording contains
      |
      |A recording is one DuckDB file. Open it with any DuckDB client.
      |`./skein export FILE --parquet DIR` turns it into Parquet, `./skein export FILE --mcap FILE` into a file for
      |[Foxglove](guides/foxglove.md).
      |
      |Names of columns end in their unit: `Ns` whole nanoseconds, `Ms` milliseconds, `M` metres, `Mps` metres per
      |second, `Rad` radians, `RadPerS` radians per second. `North`, `East`, `Down` are axes of the world frame;
      |`Front`, `Right`, `Down` those of the body frame. `validAtNs` (also `ownValidAtNs` and similar), `actsAtNs` and
      |`predictedForNs` are on the simulator's clock, all other instants on the controller's. `sequence` counts the rows
      |of a vehicle; other tables refer to it. Every table begins with `row`, the order in which all rows of the flight
      |were accepted.
      |
      |```sql
      |-- how old the data of each vehicle's decisions was, by the simulator's clock
      |SELECT vehicle, avg(ownTrueAgeMs), quantile_cont(ownTrueAgeMs, 0.99) FROM decision GROUP BY vehicle;
      |```
      |""".stripMargin

  private def meaning(table: String): String = table match
    case "flight"    => "What was flown: one row."
    case "parameter" => "Further settings of the flight, such as those of its scenario."
    case "vehicle"   => "One row for each vehicle; `start…` is its own frame's origin in the world frame."
    case "reading"   => "One row for each answer of the simulator."
    case "decision"  =>
      "One row for each decision, with the readings it was made from. `ownAge` and `opponentAge` count " +
        "from a reading's arrival, as in the paper; `ownTrueAge` and `opponentTrueAge` from its valid " +
        "time, with `uncertainty` as the bound of their error. `relativeX` and `relativeY` are the " +
        "position of the evader relative to the pursuer, along its commanded heading and to the right of " +
        "it (for other roles, of the opponent relative to the vehicle). `elapsed` is the time since the " +
        "vehicle's last decision, `actsAt` the predicted time at which the command acts."
    case "sighting"    => "The readings of the other vehicles that a decision for a team was made from."
    case "measurement" => "One row for each answer of a sensor; `quantities` names its numbers, with units."
    case "sensing"     =>
      "The measurements that a decision was made from: one row for each sensor that its policy reads."
    case "image" =>
      "One row for each image, if images are recorded (`fly --images`). `pixels` are " +
        "compressed by Zstandard: rows from the top, `bgr8`, or `32FC1` as numbers of 32 " +
        "bits. Position and orientation are the camera's at the exposure."
    case "cloud" =>
      "One row for each scan of a lidar, if scans are recorded. `xyz` are compressed by " +
        "Zstandard: three numbers of 32 bits for each point, in the lidar's frame."
    case "plan" =>
      "How a plan was found: candidates, slices of each search, cost, broken limits; the " +
        "planned path, from the moment at which its command acts, a position for each step; and what no " +
        "reading tells of the states that it begins with, as numbers of the vehicle's and its opponent's plant."
    case "solved" =>
      "Decisions that were made in another process: when the question left and the answer came, " +
        "and how long the solver took. Questions without a row were not answered in time."
    case "prediction"      => "Predictions that a later reading could be compared with, and their errors."
    case "command"         => "One row for each command as it was sent."
    case "acknowledgement" => "How each command ended."
    case "latency"         => "Round trips over the link."
    case "event"           =>
      "Everything unusual: every drop, skip, time-out and " +
        "reconnection; and messages of a learner beside the loop."
    case "truth"  => "True positions of vehicles, if they are sampled apart from the readings."
    case "ending" => "How the flight ended: one row, or none if the recording is incomplete."
    case other    => throw IllegalArgumentException(s"table $other has no description")
