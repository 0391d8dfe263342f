package skein.record

/** The tables of a recording as a page of the documentation. */
object RecordingSchema:

  /** Lists every table with its columns, their types, and whether they may be absent. */
  def markdown: String =
    val tables = Table.all.map: table =>
      val columns = table.numbered.map: column =>
        s"| `${column.name}` | ${column.sqlType} |${if column.nullable then " may be absent" else ""} |"
      s"## ${table.name}\n\n${meaning(table.name)}\n\n| column | " +
        s"type | |\n|---|---|---|\n${columns.mkString("\n")}\n"
    s"$introduction\n${tables.mkString("\n")}"

  private val introduction =
    """# What a recording contains
      |
      |A recording is one DuckDB file. Open it with any DuckDB client since 1.0.
      |A flight that is killed loses the rows of its last 100 ms at most; on a busy machine that takes [real-time
      |priority](decisions/0011-real-time-threads.md). A power cut during a flight may damage its file.
      |`./skein export FILE --parquet DIR` turns it into Parquet, `./skein export FILE --mcap FILE` into a file for
      |[Foxglove](guides/foxglove.md).
      |
      |Names of columns end in their unit: `Ns` whole nanoseconds, `Ms` milliseconds, `M` metres, `Mps` metres per
      |second, `Rad` radians, `RadPerS` radians per second. `North`, `East`, `Down` are axes of the world frame;
      |`Front`, `Right`, `Down` those of the body frame. `validAtNs` (also `ownValidAtNs` and similar), `actsAtNs` and
      |`predictedForNs` are on the simulator's clock, all other instants on the controller's. `sequence` counts the rows
      |of a vehicle; other tables refer to it. Of readings, [each of several controllers](loops.md#a-controller-for-each-vehicle) has numbers of its own. [Concepts](concepts.md#the-words) defines reading, decision and age. Every table begins with `row`, the order in which all rows of the flight
      |were accepted.
      |
      |```sql
      |-- how old the data of each vehicle's decisions was, by the simulator's clock
      |SELECT vehicle, avg(ownTrueAgeMs), quantile_cont(ownTrueAgeMs, 0.99) FROM decision GROUP BY vehicle;
      |```
      |""".stripMargin

  private def meaning(table: String): String = table match
    case "flight" =>
      "What was flown: one row. `clock` is real or virtual; `simulator` is `built-in`, or the address of " +
        "another; `scenario` is a title, and `scenarioName` names the scenario; `version` is that of the program."
    case "parameter" => "Further settings of the flight, such as those of its scenario: name and value."
    case "vehicle"   =>
      "One row for each vehicle, with its role in the scenario and its cruising speed; `start…` is " +
        "its own frame's origin in the world frame."
    case "reading" =>
      "One row for each answer of the simulator. `sentAt` and `receivedAt` are when it was asked for " +
        "and when the answer came. The orientation is a quaternion from the body frame to the world frame."
    case "decision" =>
      "One row for each decision. Columns that begin with `own` and `opponent` are the readings that it " +
        "was made from. `ownAge` and `opponentAge` count from a reading's arrival, as in the paper; " +
        "`ownTrueAge` and `opponentTrueAge` from its valid time, with `uncertainty` as the bound of their " +
        "error. `sinceOwnMove` and `sinceOpponentMove` are the times since the last commands. " +
        "`relativeX` and `relativeY` are the position of the evader relative to the pursuer, along its " +
        "commanded heading, or where that was not known, the direction in which it moved, and to " +
        "the right of it (for other roles, of the opponent relative to the vehicle). `headingBefore` was commanded last, `heading` was decided now. `elapsed` is the time " +
        "since the vehicle's last decision. `actsAt` is the predicted time at which the command acts, and " +
        "`…Predicted…` are the states predicted for it, if the decision was made from them. `action…` is " +
        "absent where heading and speed, at the altitude of the start, are the whole action."
    case "sighting" =>
      "The readings of the other vehicles that a decision for a team was made from: one row for each of " +
        "them. `decider` and `decision` name the decision, `vehicle` and `reading` the reading."
    case "measurement" => "One row for each answer of a sensor; `quantities` names its numbers, with units."
    case "sensing"     =>
      "The measurements that a decision was made from: one row for each sensor that its policy reads. " +
        "`decision` and `measurement` are sequences."
    case "image" =>
      "One row for each image, if images are recorded (`fly --images`). `pixels` are " +
        "compressed by Zstandard: rows from the top, `bgr8`, or `32FC1` as numbers of 32 " +
        "bits. Position and orientation are the camera's at the exposure, which is `validAt`."
    case "cloud" =>
      "One row for each scan of a lidar, if scans are recorded. `xyz` are compressed by " +
        "Zstandard: three numbers of 32 bits for each point, in the lidar's frame."
    case "plan" =>
      "How a decision was planned. `candidates` were simulated by all searches together. `slices` are the " +
        "steps that each search finished before the deadline; if all are 0, the last plan went on or the " +
        "policy decided. `cost` is that of the chosen plan, and `breaches` counts its broken limits. " +
        "`course…` is the planned path: a position at the end of each step, the first of which begins when " +
        "the command acts. `ownState` and `opponentState` are the states of the plants from which it was " +
        "planned, where readings do not show all of them."
    case "solved" =>
      "Decisions that were made in another process: when the question left and the answer came, " +
        "and for how long the solver computed (`thinking`). Questions without a row were not answered in " +
        "time. `solverClockOffset` is the controller's clock minus the solver's."
    case "prediction" =>
      "Predictions that a later reading could be compared with. `age` is from the reading that was carried " +
        "forward to the moment predicted for, `error` the distance to where the vehicle was then."
    case "command" =>
      "One row for each command as it was sent. `decision` is absent for take-off, hover and the like."
    case "acknowledgement" =>
      "How each command ended: `outcome` is `done`, `superseded` (a newer command replaced it), or " +
        "`failed`, with the `error`."
    case "latency" => "Round trips over the link."
    case "event"   =>
      s"Everything unusual. `kind` is ${listed(EventKind.values.toVector.map(_.toString))}: " +
        "[what each means](report.md#events). `decision` is the one that a fallback made, or the first " +
        "after something was learned or a solver was restarted. `about` is what the event is about, if " +
        s"that is ${listed(EventSubject.values.toVector.map(_.toString))}; `count` how many, if more than one."
    case "truth"  => "True positions of vehicles, if they are sampled apart from the readings."
    case "ending" =>
      s"How the flight ended: one row, or none if the recording is incomplete. `how` is " +
        s"${listed(EndingKind.values.toVector.map(_.toString))}; `reason` says why it ended early."
    case other => throw IllegalArgumentException(s"table $other has no description")

  private def listed(names: Seq[String]): String =
    s"${names.init.map(name => s"`$name`").mkString(", ")} or `${names.last}`"
