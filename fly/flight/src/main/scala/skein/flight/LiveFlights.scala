package skein.flight

import java.nio.file.{Files, Path}
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.Materializer
import scala.concurrent.{Future, Promise}
import scala.util.Try
import scala.util.control.NonFatal
import skein.link.FavouredThread
import skein.loop.RunningGraph
import skein.record.{DuckDbRecorder, ObservedRecorder, Recordable, Recorder, RecordingHeader, RowSink}
import skein.settings.FlightPlan

/** Flights in real time, side by side, each with its own recording in `folder`. */
final class LiveFlights private (assembler: Vector[FlightAssembly])(using system: ActorSystem):
  import system.dispatcher

  /** Completes when all have ended and their recordings are closed. */
  val landed: Future[Vector[FlightResult]] = Future.sequence(assembler.map(_.landed))

  /** Ends all flights immediately; vehicles hover. */
  def stop(): Unit = assembler.foreach(_.flight.stop())

  /** Ends one flight immediately; its vehicles hover.
    *
    * @param why the recorded reason
    */
  def stop(id: String, why: String): Unit = of(id).foreach(_.stop(why))

  /** Pauses one flight's decisions: its vehicles hover until it continues or ends; its time runs on.
    *
    * @param who the recorded user
    */
  def pause(id: String, who: String): Unit = of(id).foreach(_.pause(who))

  /** Continues a paused flight.
    *
    * @param who the recorded user
    */
  def continue(id: String, who: String): Unit = of(id).foreach(_.continue(who))

  def has(id: String): Boolean = of(id).isDefined

  private def of(id: String) = assembler.find(_.plan.id == id)

  def graphs: Vector[(id: String, graph: RunningGraph)] =
    assembler.map(assembly => (assembly.plan.id, assembly.graph))

  def progress: Vector[FlightProgress] = assembler.map(_.progress)

object LiveFlights:

  /** Starts either all flights or no flight.
    *
    * @param observe called with each flight's heading; its result is called with every record of that flight,
    *   and must not block
    * @param beside receives a flight's rows in addition to its recording, or why it cannot
    * @param abandoned completes with the reason if flights that have not started yet are not waited for
    * @return Left says why they cannot start; those that had started were stopped again
    */
  def start(
      assembler: FlightAssembler,
      plans: Vector[FlightPlan],
      folder: Path,
      observe: RecordingHeader => Recordable => Unit = _ => _ => (),
      beside: (FlightPlan, RecordingHeader) => Either[String, Vector[RowSink]] =
        (_, _) => Right(Vector.empty),
      abandoned: Future[String] = Future.never
  )(using system: ActorSystem): Future[Either[String, LiveFlights]] =
    import system.dispatcher
    def begin(plan: FlightPlan): Future[Either[String, FlightAssembly]] =
      val heading = assembler.heading(plan, clockKind = "real")
      beside(plan, heading) match
        case Left(reason) => Future.successful(Left(reason))
        case Right(sinks) =>
          val threads = FavouredThread.factory("skein-record")
          DuckDbRecorder
            .open(plan.file(folder), heading, beside = sinks, threads = threads)
            .flatMap:
              case Left(error)     => Future.successful(Left(error.message))
              case Right(recorder) => record(plan, recorder, observe(heading))

    def record(plan: FlightPlan, recorder: Recorder, observer: Recordable => Unit) =
      // It lives as long as the flight, whose graph can be requested until then.
      val own      = Materializer(system)
      val starting = assembler
        .start(plan, ObservedRecorder(recorder, observer, assembler.keeps), Some(own))
        .recover { case NonFatal(error) => Left(s"it could not be started: $error") }
      val begun = Promise[Either[String, FlightAssembly]]()
      abandoned.foreach(why => begun.trySuccess(Left(why)))
      starting.foreach: answer =>
        // After it was abandoned, it must not fly.
        if !begun.trySuccess(answer) then answer.foreach(_.flight.stop())
      begun.future.flatMap:
        case Left(reason) =>
          own.shutdown()
          recorder
            .close()
            .map: _ =>
              unmade(plan.file(folder))
              Left(s"${plan.id}: $reason")
        case started =>
          for assembly <- started do assembly.landed.onComplete(_ => own.shutdown())
          Future.successful(started)

    Future
      .sequence(plans.map(begin))
      .flatMap: started =>
        val flying = started.collect { case Right(assembly) => assembly }
        started.collectFirst { case Left(reason) => reason } match
          case None         => Future.successful(Right(LiveFlights(flying)))
          case Some(reason) =>
            flying.foreach(_.flight.stop())
            Future
              .sequence(flying.map(_.landed))
              .map: _ =>
                flying.foreach(assembly => unmade(assembly.plan.file(folder)))
                Left(reason)

  /** Deletes the recording of a flight that did not start: it would prevent the next attempt. */
  private def unmade(file: Path): Unit =
    for name <- Seq(file.getFileName.toString, s"${file.getFileName}.wal") do
      val _ = Try(Files.deleteIfExists(file.resolveSibling(name)))
