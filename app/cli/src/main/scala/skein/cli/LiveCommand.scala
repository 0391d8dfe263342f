package skein.cli

import java.nio.file.Path
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.duration.*
import scala.concurrent.Promise
import skein.flight.{
  FlightAssembler,
  FlightResult,
  LiveFlights,
  NotFlown,
  OutsideRequests,
  ProgressBoard
}
import skein.link.{Address, TcpTransport}
import skein.loop.LoopKind
import skein.record.Recordable
import skein.settings.{FlightPlan, FlySettings}
import skein.units.Clock

/** Runs the live flights of `./skein fly`.
  *
  * @param simulator a running simulator; without it, each flight starts a built-in one
  * @param shown shows flights while they run
  * @param sinks outputs in addition to the recordings
  * @param requests users' requests to pause or end flights
  * @param isMavlinkByTcp see [[FlightAssembler]]
  * @param ros remappings of topics, if the vehicles are reached by ROS 2
  */
private[cli] final class LiveCommand(
    settings: FlySettings,
    simulator: Option[Address],
    out: Path,
    shown: Option[OnShow],
    sinks: RecordOptions.Sinks,
    requests: OutsideRequests,
    secured: SolverSecurity.Checked,
    isMavlinkByTcp: Boolean,
    ros: Option[Seq[String]]
):
  import LiveCommand.*

  /** Runs all flights; blocks until the last has ended. */
  def fly(plans: Vector[FlightPlan]): Either[String, Flown] =
    Edge.withSystem("skein"):
      val assembler = FlightAssembler(
        TcpTransport(),
        Clock.system,
        settings,
        simulator,
        tell = tell,
        calledOff = requests.calledOff,
        solvers = SolverOptions.reached(settings, secured),
        isWatched = shown.isDefined,
        isMavlinkByTcp = isMavlinkByTcp,
        elsewhere = ros.map(RosSource(_, Clock.system))
      )
      val isOwn = simulator.isEmpty && ros.isEmpty
      if isOwn then together(assembler, plans).map(Flown(_, None)) else inTurn(assembler, plans)

  /** Runs flights one after another on a running simulator. Completed flights are kept when a later one
    * cannot start; Ctrl-C ends them all.
    */
  private def inTurn(assembler: FlightAssembler, plans: Vector[FlightPlan])(using
      ActorSystem
  ): Either[String, Flown] =
    if plans.exists(_.loop == LoopKind.Paused) then
      Console.err.println(
        "paused: the simulator will stand still between steps, for " +
          "all its clients; other --loop leave it running"
      )
    val flown = plans.foldLeft(Flown(Vector.empty, None)): (before, plan) =>
      if before.grounded.isDefined then before
      else if Edge.isInterrupted then
        before.copy(grounded = Some(s"${plan.id} and later flights were not flown"))
      else
        Console.err.println(s"${plan.id}: the vehicles are brought to their starts")
        together(assembler, Vector(plan)) match
          case Left(reason)  => before.copy(grounded = Some(reason))
          case Right(landed) => before.copy(landed = before.landed ++ landed)
    flown.grounded match
      case Some(reason) if flown.landed.isEmpty => Left(reason)
      case _                                    => Right(flown)

  private def together(assembler: FlightAssembler, plans: Vector[FlightPlan])(using
      system: ActorSystem
  ): Either[String, Vector[FlightResult]] =
    import system.dispatcher
    val abandoned = Promise[String]()
    def stop()    =
      val why = "ended from outside before it began"
      requests.stopAll(why)
      // Silent vehicles are not waited for.
      system.scheduler.scheduleOnce(CalledOffWithin)(abandoned.trySuccess(why): Unit): Unit
    Edge.untilInterrupted(() => stop()):
      Edge
        .await(LiveFlights.start(
          assembler,
          plans,
          out,
          heading => shown.fold((_: Recordable) => ())(_.observe(heading)),
          sinks.open,
          abandoned.future
        ))
        .left
        .map: why =>
          sinks.discard(plans)
          why
        .map: flights =>
          requests.flying(flights)
          shown.foreach(_.flying(flights))
          val board = ProgressBoard(plans.map(_.id), settings.duration, System.err)
          val timer =
            system.scheduler.scheduleAtFixedRate(500.millis, 500.millis)(() => board.show(flights.progress))
          try Edge.await(flights.landed)
          finally
            val _ = timer.cancel()
            board.close()

private[cli] object LiveCommand:
  /** @param grounded why some flights were not run, if so */
  final case class Flown(landed: Vector[FlightResult], grounded: Option[String]):
    def and(more: Flown): Flown =
      Flown(landed ++ more.landed, (grounded ++ more.grounded).reduceOption(_ + "\n" + _))

  object Flown:
    /** Flights in virtual time, of which some may be missing. */
    def virtual(missing: Vector[NotFlown], landed: Vector[FlightResult]): Flown =
      Flown(
        landed,
        Option.when(missing.nonEmpty)(NotFlown.message(missing, missing.size + landed.size))
      )

  /** Approximate time within which vehicles on the way to their starts receive a hover command. */
  private val CalledOffWithin = 5.seconds

  /** Prints an in-flight problem above the progress line. */
  private def tell(line: String): Unit =
    Console.err.println((if Terminal.isThere then "\r\u001b[K" else "") + line)
