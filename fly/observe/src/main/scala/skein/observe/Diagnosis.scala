package skein.observe

import skein.units.Decimals.{brief, counted, fixed}

/** A fault of a loop's timing, with its remedy.
  *
  * @param name name for scripts, equal for all loops
  * @param what the observation, with its figures
  * @param remedy what to change
  */
final case class Finding(name: String, what: String, remedy: String)

/** Diagnoses common faults of a loop's timing from observations. A pure function; the most costly fault is
  * first.
  */
object Diagnosis:

  /** A delay is reported from this share of a period on. */
  private val Notable = 0.2

  /** Maximum number of simultaneous calls that AirSim surely answers: each unanswered move occupies one of
    * its workers.
    */
  private val MostMoves = 2

  /** Factor by which images slow small calls on a link that they fill. */
  private val SlowedBy = 2.0

  /** Quantile by which small calls are compared. A program that waits for each answer sends few calls while
    * an image's bytes are ahead of them, and more afterwards.
    */
  private val Slow = 0.75

  /** A physics step of AirSim, by which the time stamps of simultaneous readings may differ. */
  private val LeastSkewMs = 3.0

  private val RateWithin = 0.02

  def of(observed: Observed): Vector[Finding] =
    Vector(
      images(observed),
      waitsForMoves(observed),
      inTurn(observed),
      saturated(observed),
      manyMoves(observed),
      overtaken(observed),
      superseded(observed),
      leftRunning(observed),
      stalls(observed),
      clock(observed),
      failed(observed),
      blind(observed)
    ).flatten

  private def period(observed: Observed): Double = observed.periodMs.values.sum

  private def images(observed: Observed): Option[Finding] =
    val spent = observed.periodMs.getOrElse(LoopAccount.Phases(0), 0.0)
    Option.when(observed.imagesOnCommandConnections > 0 && spent > Notable * period(observed)):
      Finding(
        "images in the control loop",
        s"images take ${spent.brief} ms of each period of ${period(observed).brief} ms, on the connection that commands",
        "take images on a connection (a client) and a thread of their own, and decide by the newest one that has come"
      )

  private def waitsForMoves(observed: Observed): Option[Finding] =
    ofWorst(observed, above = 0.5)(vehicle => share(vehicle, vehicle.joined)): (vehicle, share) =>
      Finding(
        "waits for each move",
        s"the program waited for the end of ${(100 * share).fixed(0)} % of the commands to ${named(vehicle)} before it did anything else",
        "send moves without waiting (no join()): a newer command replaces the one before"
      )

  private def inTurn(observed: Observed): Option[Finding] =
    val overlap = observed.readsOverlap >= 0.1
    val least   = if overlap then Double.PositiveInfinity else (Notable * stateMs(observed)).max(LeastSkewMs)
    ofWorst(observed, above = least)(_.skewMs.fold(0.0)(_.median)): (vehicle, skew) =>
      Finding(
        "reads in turn",
        s"vehicles are read one after the other: when ${named(vehicle)} is commanded, the oldest reading is ${skew.brief} ms older than the newest",
        "ask for all vehicles at once, on a connection for each, and join the newest answers"
      )

  private def stateMs(observed: Observed): Double =
    observed.methods.filter(
      _.kind == CallKind.State
    ).flatMap(_.roundTripMs).map(_.median).maxOption.getOrElse(0.0)

  private def saturated(observed: Observed): Option[Finding] =
    for
      quiet  <- observed.smallCallMs.quiet
      beside <- observed.smallCallMs.besideImages
      (slow, usual) = (beside.quantile(Slow), quiet.quantile(Slow))
      if beside.count >= 10 && slow > SlowedBy * usual && slow - usual > 2
    yield Finding(
      "images fill the link",
      s"a quarter of small calls take ${slow.brief} ms or more while an image is under way, ${usual.brief} ms else",
      "ask for fewer, smaller or compressed images; a faster link helps, more threads do not"
    )

  private def manyMoves(observed: Observed): Option[Finding] =
    ofWorst(observed, above = MostMoves)(_.mostInFlight): (vehicle, most) =>
      Finding(
        "many moves unanswered",
        s"up to ${most.toInt} commands to ${named(vehicle)} were unanswered at once",
        s"keep at most $MostMoves: AirSim holds a worker for each, and stands still when it has none left"
      )

  private def overtaken(observed: Observed): Option[Finding] =
    ofWorst(observed, above = 0)(_.overtaken.toDouble): (vehicle, count) =>
      Finding(
        "commands overtake one another",
        s"${counted(count.toLong, "command")} to ${named(vehicle)} acted after a later one",
        "send all commands of a vehicle on one connection"
      )

  private def superseded(observed: Observed): Option[Finding] =
    ofWorst(observed, above = 0.05)(vehicle => share(vehicle, vehicle.superseded)): (vehicle, share) =>
      Finding(
        "commands come in bursts",
        s"${(100 * share).fixed(0)} % of the commands to ${named(vehicle)} were replaced within 3 ms, before physics made a step",
        "send one command a period"
      )

  private def leftRunning(observed: Observed): Option[Finding] =
    ofWorst(observed, above = 0)(_.leftRunning.toDouble): (vehicle, count) =>
      Finding(
        "moves left running",
        s"${counted(count.toLong, "command")} to ${named(vehicle)} still ran when the program left",
        "hover() or cancelLastTask() at the end: a move goes on until its duration is over"
      )

  private def stalls(observed: Observed): Option[Finding] =
    observed.stalls.headOption.map: longest =>
      Finding(
        "stalls",
        s"${counted(observed.stalls.size, "stall")}, the longest of ${longest.length.toMillis.brief} ms in ${longest.method}, " +
          s"${longest.at.toSeconds.fixed(1)} s after the start",
        "see what else runs on the machines and on the link at these times; a busy simulator answers nobody"
      )

  private def clock(observed: Observed): Option[Finding] = observed.clock.flatMap: clock =>
    if clock.backwards > 0 then
      Some(Finding(
        "the simulator's clock goes back",
        s"${counted(clock.backwards, "time")}: it was reset or restarted, and ages across that are wrong",
        "observe a run without resets"
      ))
    else if observed.pauses == 0 && clock.stoodStill.toMillis > 100 then
      Some(Finding(
        "the simulator stands still",
        s"for ${clock.stoodStill.toSeconds.fixed(1)} s in all, while nobody paused it",
        "it is overloaded, or all its workers wait for moves"
      ))
    else
      Option.when(observed.pauses == 0 && math.abs(clock.rate - 1) > RateWithin):
        Finding(
          "the simulator is not at real time",
          s"its clock runs at ${clock.rate.fixed(2)} of real time",
          "ages are in real milliseconds; scale them by this for the simulator's"
        )

  private def failed(observed: Observed): Option[Finding] =
    observed.methods.filter(_.failed > 0).sortBy(-_.failed).headOption.map: method =>
      Finding(
        "calls fail",
        s"${method.failed} of ${method.calls} calls of ${method.method}; the first: ${method.firstError.getOrElse("")}",
        "see the simulator's answer"
      )

  /** Finds commands that are based on no reading at all. */
  private def blind(observed: Observed): Option[Finding] =
    observed.vehicles.find(vehicle => vehicle.commands > 0 && vehicle.ownAgeMs.isEmpty).map: vehicle =>
      Finding(
        "commands without readings",
        s"${named(vehicle)} was commanded and never read: the age of its data cannot be told",
        "nothing, if it decides by images or from a file"
      )

  /** The commanded vehicle with the largest value of a quantity, if that exceeds a limit. */
  private def ofWorst(observed: Observed, above: Double)(by: ObservedVehicle => Double)(
      finding: (ObservedVehicle, Double) => Finding
  ): Option[Finding] =
    observed.vehicles
      .filter(_.commands > 0)
      .map(vehicle => (vehicle, by(vehicle)))
      .maxByOption(_._2)
      .filter(_._2 > above)
      .map(finding(_, _))

  private def share(vehicle: ObservedVehicle, of: Long) = of.toDouble / vehicle.commands

  private def named(vehicle: ObservedVehicle) =
    if vehicle.name.isEmpty then "the first vehicle" else vehicle.name
