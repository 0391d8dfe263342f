package skein.report

import skein.measure.Distribution
import skein.observe.{Diagnosis, LoopAccount, Observed, ObservedCommand, ObservedVehicle, Progress}
import skein.units.Decimals.{brief, fixed}

/** The observer's measurements, as tables and sentences. */
object ObservedTables:

  /** Tables for people; the findings are sentences ([[findings]]). */
  def tables(observed: Observed): Vector[Section] =
    Vector(vehicles(observed.vehicles), period(observed), methods(observed)).flatten

  /** Tables for scripts, with the findings. */
  def data(observed: Observed): Vector[Section] = tables(observed) ++ found(observed)

  /** A section with a table; None without rows. */
  private[report] def section(
      title: String,
      header: Vector[String],
      rows: Vector[Vector[String]],
      note: String = ""
  ): Option[Section] = Option.when(rows.nonEmpty)(Section(title, note, Some(TextTable(header, rows))))

  private def vehicles(observed: Vector[ObservedVehicle]) = ages(
    observed,
    unnamed = "(the first)",
    bounds = Vector("± ms" -> (_.boundMs.fold("")(_.brief))),
    further = Vector("in flight at most" -> (_.mostInFlight.toString)),
    "Ages count from when physics was sampled to when the command left the program; means, and 99th percentiles. " +
      "They lie within ± of the truth."
  )

  private type Columns = Vector[(String, ObservedVehicle => String)]

  /** The ages of the data behind the commands to each vehicle.
    *
    * @param unnamed the name for a vehicle without one
    * @param bounds columns behind those of ages
    * @param further columns behind all others
    */
  private[report] def ages(
      observed: Vector[ObservedVehicle],
      unnamed: String,
      bounds: Columns,
      further: Columns,
      note: String
  ): Option[Section] =
    def since(vehicle: ObservedVehicle) = mean(vehicle.sinceOthersMs)
    val columns                         = Vector[(String, ObservedVehicle => String)](
      "<vehicle"        -> (vehicle => if vehicle.name.isEmpty then unnamed else vehicle.name),
      "commands"        -> (_.commands.toString),
      "every ms"        -> (vehicle => mean(vehicle.everyMs)),
      "p99"             -> (vehicle => p99(vehicle.everyMs)),
      "own data ms"     -> (vehicle => mean(vehicle.ownAgeMs)),
      "p99"             -> (vehicle => p99(vehicle.ownAgeMs)),
      "others' data ms" -> (vehicle => mean(vehicle.othersAgeMs)),
      "p99"             -> (vehicle => p99(vehicle.othersAgeMs))
    ) ++ bounds ++ Vector("since others' command ms" -> since) ++ further
    section(
      "How old the data behind each command was",
      columns.map(_._1),
      observed.filter(_.commands > 0).map(vehicle => columns.map(_._2(vehicle))),
      note
    )

  private def period(observed: Observed) = section(
    "Where a period goes",
    Vector("<waiting for", "ms", "%"),
    for
      phase <- LoopAccount.Phases
      ms    <- observed.periodMs.get(phase).toVector
      whole = observed.periodMs.values.sum
    yield Vector(phase, ms.brief, if whole > 0 then (100 * ms / whole).fixed(0) else "")
  )

  private def methods(observed: Observed) = section(
    "Calls",
    Vector("<method", "<kind", "calls", "a second", "failed", "median ms", "p99", "most", "MB"),
    observed.methods.map: method =>
      val seconds = observed.lasted.toSeconds
      Vector(
        method.method,
        method.kind.label,
        method.calls.toString,
        if seconds > 0 then (method.calls / seconds).brief else "",
        method.failed.toString,
        method.roundTripMs.fold("")(_.median.brief),
        p99(method.roundTripMs),
        method.roundTripMs.fold("")(_.most.brief),
        (method.answerBytes * 1e-6).fixed(1)
      )
  )

  private def found(observed: Observed) = section(
    "Findings",
    Vector("<finding", "<seen", "<remedy"),
    Diagnosis.of(observed).map(finding => Vector(finding.name, finding.what, finding.remedy))
  )

  /** A paragraph for each finding, and one for the limits of the observation. */
  def findings(observed: Observed): Vector[String] =
    val found    = Diagnosis.of(observed)
    val sentence =
      if observed.commands == 0 then Vector("Nothing was commanded, so there is no loop to judge.")
      else if found.isEmpty then Vector("No fault of timing was found.")
      else found.map(one => s"${one.name.capitalize}: ${one.what}. Remedy: ${one.remedy}.")
    val paused = Option.when(observed.pauses > 0):
      s"The program paused or stepped the simulator ${observed.pauses} times: while time stands still, ages grow and data does not get old."
    val lost =
      observed.lost.map(reason => s"Not understood from there on, and passed on all the same: $reason.")
    val more = Option.when(observed.notKept > 0)(
      s"${observed.notKept} pieces passed while the observer was behind; their connections are not counted any more."
    )
    sentence ++ paused ++ lost ++ more

  private val columns = Vector("atS", "vehicle", "method", "connection", "ownAgeMs", "othersAgeMs") ++
    Vector("boundMs", "sinceOwnMs", "sinceOthersMs", "unanswered")

  /** A row for each command that the log holds, as comma-separated values; an empty cell is unknown. */
  def csv(log: Vector[ObservedCommand]): String =
    def text(word: String) =
      if word.matches("[^\",\n\r]*") then word else s"\"${word.replace("\"", "\"\"")}\""
    def number(value: Option[Double]) = value.fold("")(_.fixed(3))
    val rows                          = log.map: command =>
      import command.*
      (Vector(at.toSeconds.fixed(6), text(vehicle), text(method), connection.toString) ++
        Vector(ownAgeMs, othersAgeMs, boundMs, sinceOwnMs, sinceOthersMs).map(number) :+
        unanswered.fold("")(_.toString)).mkString(",")
    (columns.mkString(",") +: rows).mkString("", "\n", "\n")

  /** Progress in one line; None before the first command. */
  def line(progress: Progress): Option[String] =
    Option.when(progress.commands > 0):
      val age = progress.agesMs match
        case Vector()                        => "never read"
        case Vector(one)                     => s"data ${one.ms.brief} ms old"
        case all if all.sizeIs <= MostInLine =>
          all.map(one => s"${one.vehicle} ${one.ms.brief}").mkString("data of ", ", ", " ms old")
        case all => s"data of ${all.size} vehicles up to ${all.map(_.ms).max.brief} ms old"
      s"${progress.lasted.toSeconds.fixed(0)} s: ${progress.commands} commands, $age"

  private val MostInLine = 4

  private[report] def mean(samples: Option[Distribution]) = samples.fold("")(_.mean.brief)
  private[report] def p99(samples: Option[Distribution])  = samples.fold("")(_.p99.brief)
