package skein.loop

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.Materializer
import scala.concurrent.{Future, Promise}
import skein.policy.{Action, Fleet}
import skein.port.{Sensor, VehicleError, VehiclePort}
import skein.record.{Recordable, RecordError, Recorder, Written}
import skein.signal.{Kinematics, Stamped}
import skein.units.*

/** The graph of a loop without a flight: starts it for vehicles that never answer, requests its parts from
  * the interpreter, and ends it.
  */
object LoopInstance:

  /** The graph of a loop. Absent for `paused`, which is a sequence of steps without a graph. */
  def graph(loop: AnyLoop, fleet: Fleet, settings: LoopSettings = LoopSettings())(using
      system: ActorSystem
  ): Future[Option[LoopGraph]] =
    import system.dispatcher
    if loop == LoopKind.Paused then Future.successful(None)
    else
      val ports  = fleet.agents.map(agent => Silent(agent.policy.sensors))
      val team   = Team(fleet, ports, Clock.system, Forgetting, settings)
      val own    = Materializer(system)
      val flight =
        Flight.start(loop, team, None, Span.ofSeconds(600), Clock.system, Forgetting, on = Some(own))
      flight.outcome.onComplete(_ => own.shutdown())
      val running = RunningGraph(team.meters, flight.streams)
      // The interpreter of a graph that has just started reports nothing yet.
      UntilCertain(running.shape(), MostAsked, AskEvery)(_.isDefined).andThen(_ => flight.stop())

  private val AskEvery  = Span.ofMillis(10)
  private val MostAsked = 500

  private final class Silent(asked: Set[String]) extends VehiclePort:
    def read(): Future[Either[VehicleError, Stamped[Kinematics]]]               = Future.never
    def act(action: Action, lasts: Span): Future[Either[VehicleError, Boolean]] = Future.never
    def hover(): Future[Either[VehicleError, Boolean]] = Future.successful(Right(true))
    override val sensors: Map[String, Sensor]          = asked.iterator.map(_ -> Unheard).toMap

  private object Unheard extends Sensor:
    def columns: Vector[String]                                       = Vector.empty
    def read(): Future[Either[VehicleError, Stamped[IArray[Double]]]] = Future.never

  private object Forgetting extends Recorder:
    def offer(record: Recordable): Unit               = ()
    val failure: Future[RecordError]                  = Promise[RecordError]().future
    def close(): Future[Either[RecordError, Written]] = Future.successful(Right(Written.nothing))
