package skein.cli

import java.nio.file.Path
import java.util.concurrent.atomic.AtomicInteger
import mainargs.{Flag, ParserForClass, arg}
import scala.collection.concurrent.TrieMap
import scala.util.Try
import skein.flight.{AirSimFleet, FlightResult, OutsideRequests, VirtualFlights, WarmUp}
import skein.link.{Address, TcpTransport}
import skein.forward.Asking
import skein.loop.{AnyLoop, FlightOutcome, LoopKind}
import skein.measure.{FlightSet, FlightSummary}
import skein.record.{ClockKind, DuckDbRecorder}
import skein.report.{Report, ReportSections, Typed}
import skein.scenario.Scenarios
import skein.scene.Scene
import skein.settings.{FlightPlan, FlySettings, Wire}
import skein.units.{Clock, Decimals, Expect}
import skein.units.Decimals.brief
import skein.view.Shows

/** Command-line options of `./skein fly`, with their help texts. */
final case class FlyOptions(
    flights: FlightOptions,
    @arg(doc =
      "a simulator that runs already, AirSim for example; with --mavlink by UDP, or by " +
        "TCP as tcp://HOST:PORT; without it, each flight has a built-in one"
    )
    simulator: Option[String],
    @arg(doc =
      "flies vehicles behind topics of ROS 2, which must be installed: /NAME/odom is read, /NAME/cmd_vel is sent; " +
        "not for paused"
    )
    ros: Flag,
    @arg(
      name = "ros-remap",
      doc = "another name of a topic for --ros, as ROS 2 remaps it: FROM:=TO; can be repeated"
    )
    rosRemap: Seq[String],
    @arg(doc =
      "real, or virtual: the same flights in virtual time, many times faster, the same for the same seed"
    )
    clock: String = "real",
    @arg(doc =
      "how often each live flight is flown again in virtual time, " +
        "for the report's comparison; 0 for not at all (default: 1)"
    )
    twins: Option[Int],
    @arg(doc = "folder for recordings and report; without it, flights/DATE-TIME")
    out: Option[String],
    beside: RecordOptions,
    learning: LearnInFlight,
    secured: SolverSecurity,
    view: ViewOptions,
    @arg(doc = Shown.Doc)
    json: Flag
)

/** `./skein fly`: runs loops over links, live or in virtual time, and reports on them. */
final class FlyCommand(using Scenarios)
    extends Command[FlyOptions](
      "fly",
      "flies a scenario, by default the paper's duel, and writes a report",
      ParserForClass[FlyOptions]
    ):

  override protected def defaults: Map[String, String]   = FlightOptions.defaults
  override protected def known: Map[String, Seq[String]] = FlightOptions.known

  /** Other programs' ROS 2 nodes do not stop for `paused`. */
  private def settingsOf(options: FlyOptions) = options.flights.settingsOf(mayPause = !options.ros.value)

  override protected def check(options: FlyOptions): Either[String, Unit] =
    settingsOf(options).map(_ => ())

  protected def execute(options: FlyOptions): Either[String, Unit] =
    for
      settings <- settingsOf(options)
      learning <- options.learning.chosen(settings)
      plans = learning.fold(settings.plans)(settings.plansWith)
      isTcp = options.simulator.exists(_.startsWith(FlyCommand.Tcp))
      named = options.simulator.map(_.stripPrefix(FlyCommand.Tcp))
      simulator <- Expect.optional(named)(Address.parse).left.map("--simulator: " + _)
      _         <- Expect.that(!isTcp || settings.wire == Wire.Mavlink):
        s"--simulator: ${FlyCommand.Tcp} is for --mavlink alone; AirSim's protocol is always TCP"
      _ <- Expect.that(simulator.isEmpty || settings.scene.isEmpty):
        "--scene is for the built-in simulator; --simulator has a scene of its own"
      _ <- Expect.that(simulator.isEmpty || settings.plant.isAirSim):
        "--plant is for the built-in simulator; --simulator has models of its own"
      _ <- Expect.that(simulator.isEmpty || settings.sensors.isEmpty || settings.wire == Wire.AirSim):
        "--sensors: not together with --simulator over MAVLink, which does not say what errors its readings have"
      _ <- Expect.that(settings.only.isEmpty || simulator.isDefined && options.twins.forall(_ == 0)):
        "--only: expected with --simulator, where other processes fly the rest, and without --twins"
      twins = options.twins.getOrElse(if settings.only.isEmpty then FlyCommand.Twins else 0)
      _     <- Expect.that(twins >= 0)(s"--twins: expected 0 or more, got $twins")
      _     <- options.view.mistake.toLeft(())
      clock <- ClockKind.parse(options.clock).left.map("--clock: " + _)
      _     <- Expect.that(
        options.ros.value || options.rosRemap.isEmpty
      )("--ros-remap: expected together with --ros")
      _ <-
        if options.ros.value then
          RosSource.mistake(settings, clock == ClockKind.Real, simulator.isDefined).toLeft(())
        else Right(())
      isShared = simulator.isDefined || options.ros.value
      _ <- options.beside.checked(clock)
      _ <-
        if clock == ClockKind.Virtual then SolverOptions.virtual(settings) else SolverOptions.real(settings)
      _ <- VirtualFlights.tooLong(settings).filter(_ => clock == ClockKind.Virtual).map("--" + _).toLeft(())
      secured <- options.secured.checked(settings.solver)
      _       <- Expect.that(settings.solver.isEmpty || learning.isEmpty):
        "--learn: a policy learns in the flight's own process; not together with --solver"
      _ <- Expect.that(!settings.planInPacket || learning.isEmpty):
        "--plan-in-packet: expected policies that do not learn in flight, since they decide for later moments too"
      _ <- Expect.that(!settings.decentralised || learning.isEmpty):
        "--decentralised: expected policies that do not learn in flight, which is one learner for all"
      _ <- Expect.that(clock == ClockKind.Real || !options.view.view.value):
        "--view shows flights in real time; look at what flew by " +
          "--clock virtual with ./skein replay --view FILE"
      _ <- Expect.that(clock == ClockKind.Real || options.twins.forall(_ == 0)):
        "--twins repeats live flights in virtual time; not together with --clock virtual"
      _ <- Expect.that(clock == ClockKind.Real || simulator.isEmpty):
        "--clock virtual flies the built-in simulator; not together with --simulator"
      out <- OutFolder.made("--out", options.out.getOrElse(OutFolder.dated("flights")))
      scene = if isShared then Scene.Empty else settings.world.scene
      known = TrieMap.empty[String, Try[FlightSummary]]
      sinks = RecordOptions.Sinks(options.beside, out, scene)
      _ <- options.beside.free(plans, out)
      _ = if settings.images.nonEmpty && settings.loops.contains(LoopKind.Paused) then
        Console.err.println("paused records no images of --images; the other loops do")
      flown <- clock match
        case ClockKind.Real =>
          for
            _ <- nothingToOverwrite(plans ++ plans.flatMap(_.twins(twins)), out)
            _ <- OpenFiles.enoughFor(
              // On a running simulator, flights follow one another.
              if isShared then 1 else plans.size,
              if settings.decentralised then settings.fleet.agents.size else 1
            )
            _ <- FlyCommand.vehiclesThere(settings, simulator)
            _ = Console.err.println(
              s"warming up for ${Decimals.counted(plans.size, "live flight")} of " +
                s"${settings.duration.toSeconds.brief} s${if isShared then "" else ", side by side"}"
            )
            unlearned = if learning.isEmpty then plans.filter(Preview.isPossible) else Vector.empty
            ahead <- warmUp(
              settings.copy(policies = settings.policies ++ learning.map(_.file), images = Nil),
              unlearned.flatMap(_.twins(twins))
            )
            shows    = Shows()
            requests = OutsideRequests()
            shown    =
              Option.when(options.view.view.value)(
                OnShow(shows, requests, scene, settings.imagingSensors, settings.scenario)
              )
            ros  = Option.when(options.ros.value)(options.rosRemap)
            live = LiveCommand(settings, simulator, out, shown, sinks, requests, secured, isTcp, ros)
            flown <- options.view.serving(shows, controlled = true)(live.fly(plans))
          yield
            if shown.isEmpty then Console.err.println(FlyCommand.Viewing)
            flown.and(kept(out)(flyTwins(flown.landed, settings.copy(images = Nil), twins, ahead, out)))
        case ClockKind.Virtual =>
          for
            _ <- nothingToOverwrite(plans, out)
            _ = Console.err.println(
              s"flying ${Decimals.counted(plans.size, "flight")} of " +
                s"${settings.duration.toSeconds.brief} s in virtual time"
            )
            flown = flyVirtual(settings, plans, out)(known.put(_, _): Unit)
            _ <- Expect.that(flown.landed.nonEmpty)(flown.grounded.mkString)
            exported = Expect.all(flown.landed)(one => options.beside.exported(one.plan, out))
          yield flown.and(LiveCommand.Flown(Vector.empty, exported.left.toOption))
      unwritten = sinks.failures.map(_ + "; ./skein export makes it of the recording")
      _ <- all(
        kept(out)(report(flown.landed, known.toMap, out, Shown(options.json.value))),
        Expect.that(unwritten.isEmpty && flown.grounded.isEmpty)((unwritten ++ flown.grounded).mkString("\n"))
      )
    yield ()

  private def nothingToOverwrite(plans: Vector[FlightPlan], out: Path): Either[String, Unit] =
    val twice = plans.groupBy(_.file(out)).collectFirst { case (file, Seq(one, other, _*)) =>
      s"${one.id} and ${other.id} would both be recorded as $file: expected names that differ in letters or digits"
    }
    val there = plans.map(plan => DuckDbRecorder.free(plan.file(out))).collectFirst { case Left(why) =>
      why.message
    }
    twice.orElse(there).toLeft(())

  /** @param twins the live flights' twins; simulated here if there is time */
  private def warmUp(settings: FlySettings, twins: Vector[FlightPlan]): Either[String, Preview.Flown] =
    if settings.loops.forall(FlyCommand.warm) then Right(Map.empty)
    else
      val (clock, started) = (Clock.system, Clock.system.now())
      Edge.withSystem("skein-warm-up"):
        for
          flights <- WarmUp.fly(settings, WarmUp.Flights, clock)
          isQuick = Preview.fits(flights, clock.now().since(started), settings.duration)
          ahead   = Preview.fly(settings, if isQuick then twins else Vector.empty, clock)(Console.err.println)
          decisions <- Edge.await(WarmUp.rehearse(settings, TcpTransport(), clock))
        yield
          FlyCommand.warm ++= settings.loops
          Console.err.println(
            s"warmed up by ${Decimals.counted(flights, "virtual flight")} and $decisions decisions " +
              "over loopback, so that none waits for the compiler"
          )
          ahead

  /** Records the virtual twins of the completed live flights, and simulates those that are not in `ahead`. */
  private def flyTwins(
      landed: Vector[FlightResult],
      settings: FlySettings,
      count: Int,
      ahead: Preview.Flown,
      out: Path
  ): LiveCommand.Flown =
    val twins = landed.filter(_.outcome == FlightOutcome.Completed).flatMap(SolverOptions.twins(_, count))
    val (known, due) = twins.partition(ahead.contains)
    if twins.isEmpty || Edge.isInterrupted then LiveCommand.Flown(Vector.empty, None)
    else
      val flown = known.map: plan =>
        ahead(plan).landed.copy(written = ahead(plan).recorder.writeTo(plan.file(out)))
      if due.isEmpty then LiveCommand.Flown(flown, None)
      else
        val seeds = due.map(_.seed)
        Console.err.println(
          s"virtual twins of the live flights: ${due.size}, seeds ${seeds.min} to ${seeds.max}"
        )
        val (missing, landed) = VirtualFlights.fly(settings, due, out)((_, _) => ())
        LiveCommand.Flown.virtual(missing, flown ++ landed)

  /** @param keep called with each flight's name and summary, while its records are in memory and others still
    *   run
    */
  private def flyVirtual(
      settings: FlySettings,
      plans: Vector[FlightPlan],
      out: Path
  )(keep: (String, Try[FlightSummary]) => Unit): LiveCommand.Flown =
    val written           = AtomicInteger()
    val (missing, landed) = Edge.tellingIfCut(FlyCommand.recorded(written.get, plans.size, out)):
      VirtualFlights.fly(settings, plans, out): (landed, recorder) =>
        if landed.written.isRight then written.incrementAndGet(): Unit
        val id = landed.plan.id
        Console.err.println(s"$id has ended; SHA-256 of its recording: ${recorder.digest}")
        keep(id, Try(FlightSummary.of(recorder.recording)))
    LiveCommand.Flown.virtual(missing, landed)

  /** Prints the recordings' folder if the command is terminated after the flights. */
  private def kept[A](out: Path)(body: => A): A =
    Edge.tellingIfCut(s"the flights are recorded; ${FlyCommand.shows(out)}")(body)

  /** Reports on the flights, also after a failed one: its recording is readable to its end. If showing or
    * writing fails, all errors are reported.
    *
    * @param known summaries by the flights' names; without all of them, the recordings are read
    */
  private def report(
      landed: Vector[FlightResult],
      known: Map[String, Try[FlightSummary]],
      out: Path,
      shown: Shown
  ): Either[String, Unit] =
    val read =
      if landed.forall(flight => known.contains(flight.plan.id)) then
        Right(FlightSet(landed.map(flight => known(flight.plan.id).get)))
      else Report.read(landed.map(_.plan.file(out))).left.map(_.map(_.message).mkString("\n"))
    val told =
      read.flatMap: flights =>
        val files   = flights.all.map(_.flight.id).map(id => out.resolve(FlightPlan.fileName(id)).toString)
        shown.tables(ReportSections.of(flights), ReportSections.text(flights), "recordings" -> files)
        val written = Report.write(flights, out).flatMap: output =>
          output.told.foreach(shown.say)
          output.whole
        val ended = landed.filter(_.outcome != FlightOutcome.Completed).map(_.plan.id).toSet
        all(written, FlyCommand.undecided(flights.all.map(one => one.flight.id -> one.decisions), ended))
    all(allWell(landed), told)

  /** Combines two results; keeps both errors if there are two. */
  private def all(one: Either[String, Unit], other: Either[String, Unit]): Either[String, Unit] =
    Expect.all(Seq(one, other))(identity).map(_ => ())

  private def allWell(landed: Vector[FlightResult]): Either[String, Unit] =
    val failures = landed.flatMap: flight =>
      val ended = flight.outcome match
        case FlightOutcome.Failed(reason)                    => Some(reason)
        case FlightOutcome.Completed | FlightOutcome.Stopped => None
      ended.orElse(flight.written.left.toOption.map(_.message)).map(reason =>
        s"${flight.plan.id} failed: $reason"
      )
    Expect.that(failures.isEmpty)(failures.mkString("\n"))

private[cli] object FlyCommand:
  private val Tcp = "tcp://"

  /** Number of virtual twins for each live flight. */
  private val Twins = 1

  private val Viewing = "./skein fly --view shows flights while they fly, in the browser"

  /** Loops that this process has already warmed up: its next command can skip them. */
  @volatile private var warm = Set.empty[AnyLoop]

  /** Lets live flights of this process begin without a warm-up. */
  def skipWarmUp(): Unit = warm = LoopKind.values.toSet

  /** Checks before any warm-up that the simulator answers and has the scenario's vehicles. A MAVLink
    * simulator is checked when its vehicles move to their starts, which needs their clocks.
    */
  def vehiclesThere(settings: FlySettings, simulator: Option[Address]): Either[String, Unit] =
    simulator.filter(_ => settings.wire == Wire.AirSim).fold(Right(())): at =>
      Edge.withSystem("skein-names"):
        Edge.await(AirSimFleet.missing(settings.fleet, settings.sensors, at, TcpTransport(), Clock.system))

  /** A line for a user who ended the command, with the number of recorded virtual flights: each is recorded
    * when it ends.
    */
  def recorded(ended: Int, of: Int, out: Path): String =
    val flights = Decimals.counted(of, "flight")
    if ended == 0 then s"none of $flights has ended, and nothing is recorded"
    else s"$ended of $flights have ended and are recorded, the rest is not; ${shows(out)}"

  private def shows(out: Path) = s"./skein report ${Typed.recordings(out)} shows them"

  /** Refuses flights in which no vehicle was ever read for a decision, unless it failed or was ended by the
    * user.
    *
    * @param decisions number of decisions by flight
    * @param ended flights that failed, or that the user ended
    */
  def undecided(decisions: Seq[(String, Int)], ended: Set[String]): Either[String, Unit] =
    val idle = decisions.collect { case (id, 0) if !ended(id) => id }
    Expect.that(idle.isEmpty):
      s"nothing was decided in ${idle.mkString(", ")}: are the answers later than " +
        s"the time-out of ${Asking.Timeout.toMillis.round} ms?"
