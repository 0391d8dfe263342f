package skein.flight

import java.nio.file.{Files, Path}
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Future
import scala.util.Try
import scala.util.control.NonFatal
import skein.loop.RunningGraph
import skein.record.{DuckDbRecorder, Heading, ObservedRecorder, Record, RowSink}
import skein.settings.FlightPlan

/** Flights in real time, side by side, each with a recording of its own in `folder`. */
final class LiveFlights private (rigs: Vector[FlightRig])(using system: ActorSystem):
  import system.dispatcher

  /** Completes when all have ended and their recordings are closed. */
  val landed: Future[Vector[Landed]] = Future.sequence(rigs.map(_.landed))

  /** Ends all flights now; vehicles hover. */
  def stop(): Unit = rigs.foreach(_.flight.stop())

  /** Ends one flight now; its vehicles hover.
    *
    * @param why
    *   as it is recorded
    */
  def stop(id: String, why: String): Unit = of(id).foreach(_.stop(why))

  /** One flight's vehicles hover and nobody decides, until it continues or ends; its time runs on.
    *
    * @param who
    *   as it is recorded
    */
  def pause(id: String, who: String): Unit = of(id).foreach(_.pause(who))

  /** Lets one flight go on that is paused.
    *
    * @param who
    *   as it is recorded
    */
  def continue(id: String, who: String): Unit = of(id).foreach(_.continue(who))

  private def of(id: String) = rigs.find(_.plan.id == id)

  /** The graphs as they run, by the flights' names. */
  def graphs: Vector[(id: String, graph: RunningGraph)] = rigs.map(rig => (rig.plan.id, rig.graph))

  def progress: Vector[Progress] = rigs.map(_.progress)

object LiveFlights:

  /** Starts all flights, or none.
    *
    * @param observe
    *   is shown every record of a flight that begins with a heading; it must not wait for anything
    * @param beside
    *   what takes a flight's rows besides its recording, or why it cannot
    * @return
    *   or why they cannot be flown; those that had started were stopped again
    */
  def start(
      rigs: FlightRigs,
      plans: Vector[FlightPlan],
      folder: Path,
      observe: Heading => Record => Unit = _ => _ => (),
      beside: (FlightPlan, Heading) => Either[String, Vector[RowSink]] = (_, _) => Right(Vector.empty)
  )(using system: ActorSystem): Future[Either[String, LiveFlights]] =
    import system.dispatcher
    Future
      .sequence(plans.map(start(rigs, _, folder, observe, beside)))
      .flatMap: started =>
        val flying = started.collect { case Right(rig) => rig }
        started.collectFirst { case Left(reason) => reason } match
          case None         => Future.successful(Right(LiveFlights(flying)))
          case Some(reason) =>
            flying.foreach(_.flight.stop())
            Future
              .sequence(flying.map(_.landed))
              .map: _ =>
                flying.foreach(rig => unmade(rig.plan.file(folder)))
                Left(reason)

  private def start(
      rigs: FlightRigs,
      plan: FlightPlan,
      folder: Path,
      observe: Heading => Record => Unit,
      beside: (FlightPlan, Heading) => Either[String, Vector[RowSink]]
  )(using system: ActorSystem): Future[Either[String, FlightRig]] =
    import system.dispatcher
    val heading = rigs.heading(plan, clockKind = "real")
    val opened  = beside(plan, heading) match
      case Left(reason) => Future.successful(Left(reason))
      case Right(sinks) =>
        DuckDbRecorder.open(plan.file(folder), heading, beside = sinks).map(_.left.map(_.message))
    opened
      .flatMap:
        case Left(reason)    => Future.successful(Left(reason))
        case Right(recorder) =>
          rigs
            .start(plan, ObservedRecorder(recorder, observe(heading)))
            .recover { case NonFatal(error) => Left(s"it could not be started: $error") }
            .flatMap:
              case Left(reason) =>
                recorder
                  .close()
                  .map: _ =>
                    unmade(plan.file(folder))
                    Left(s"${plan.id}: $reason")
              case started => Future.successful(started)

  /** Takes away the recording of a flight that was not flown, which would be in the way when it is tried again. */
  private def unmade(file: Path): Unit =
    for name <- Seq(file.getFileName.toString, s"${file.getFileName}.wal") do
      val _ = Try(Files.deleteIfExists(file.resolveSibling(name)))
