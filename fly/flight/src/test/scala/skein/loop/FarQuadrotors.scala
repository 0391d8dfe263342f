package skein.loop

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.pattern.after
import scala.concurrent.{Future, Promise}
import skein.policy.{Action, ActionGuidance, Fleet}
import skein.port.{SteppedTime, VehicleError, VehiclePort}
import skein.signal.*
import skein.units.*
import skein.vehicle.{Guidance, Quadrotor, QuadrotorState, Setpoint}

/** Quadrotors in AirSim's physics behind a link, without wire or server: each direction of each vehicle
  * delays by half of a sampled round trip and keeps the order. Their clock differs from the controller's
  * clock. A move is answered when it is replaced; none ends by itself.
  */
final class FarQuadrotors(scenario: Fleet, link: LatencyProfile, seed: Long, clock: Clock)(using
    system: ActorSystem
) extends SteppedTime:
  import system.dispatcher

  private val quadrotor = Quadrotor.AirSim
  private val step      = Span.ofSeconds(quadrotor.stepS)
  private val start     = clock.now()
  private val states    = scenario.agents.map(agent => quadrotor.hovering(agent.startPositionNed))
  private val guidance = scenario.agents.map[Guidance](agent => Setpoint.hold(agent.startPositionNed)).toArray
  private val seeds    = SplitMix64(seed)
  private val linkSeed = seeds.nextLong()
  private var steps    = 0L
  private var running  = true
  private var ranFrom  = (start, 0L)

  /** Called after every step of physics with the simulator's time and the states. */
  var watch: (Span, Vector[QuadrotorState]) => Unit = (_, _) => ()

  val ports: Vector[VehiclePort] = scenario.agents.indices.map(FarQuadrotor(_)).toVector

  def pause(): Future[Either[VehicleError, Unit]] =
    catchUp()
    running = false
    done

  def resume(): Future[Either[VehicleError, Unit]] =
    running = true
    ranFrom = (clock.now(), steps)
    done

  /** Not all spans are whole steps: the remainder is added to the next one. */
  def continueFor(span: Span): Future[Either[VehicleError, Unit]] =
    heldFor = heldFor + span
    while step * (steps + 1) <= heldFor do stepOnce()
    done

  private var heldFor = Span.Zero

  private def done = Future.successful(Right(()))

  private def validAt: Instant =
    Instant.Epoch + Span.ofSeconds(1000) + (if running then step * steps else heldFor)

  private def catchUp(): Unit =
    if running then
      val due = ranFrom._2 + clock.now().since(ranFrom._1).toNanos / step.toNanos
      while steps < due do stepOnce()

  private def stepOnce(): Unit =
    steps += 1
    for (state, goal) <- states.zip(guidance) do quadrotor.step(state, goal.setpoint(state.kinematics))
    watch(step * steps, states)

  private final class Line:
    private val sampler       = LatencySampler(link, linkSeed, seeds.nextLong())
    private var arrivesAt     = start
    def cross(): Future[Unit] =
      val now = clock.now()
      arrivesAt = arrivesAt.max(now + sampler.oneWay(now.since(start)))
      if arrivesAt <= now then Future.unit
      else after(arrivesAt.since(now).toDuration, system.scheduler)(Future.unit)

  private final class FarQuadrotor(vehicle: Int) extends VehiclePort:
    private val there                            = Line()
    private val back                             = Line()
    private var flying: Option[Promise[Boolean]] = None

    def read(): Future[Either[VehicleError, Stamped[Kinematics]]] =
      val sentAt = clock.now()
      for
        _ <- there.cross()
        sampled = { catchUp(); (states(vehicle).kinematics, validAt) }
        _ <- back.cross()
      yield Right(Stamped(sampled._1, sampled._2, sentAt, clock.now()))

    def act(action: Action, lasts: Span): Future[Either[VehicleError, Boolean]] =
      val ended = Promise[Boolean]()
      for
        _ <- there.cross()
        _ = replaceBy(ActionGuidance.of(action), Some(ended))
        finished <- ended.future
        _        <- back.cross()
      yield Right(finished)

    def hover(): Future[Either[VehicleError, Boolean]] =
      for
        _ <- there.cross()
        _ = replaceBy(Setpoint.hold(states(vehicle).positionNed), None)
        _ <- back.cross()
      yield Right(true)

    private def replaceBy(goal: Guidance, next: Option[Promise[Boolean]]): Unit =
      catchUp()
      guidance(vehicle) = goal
      flying.foreach(_.success(false))
      flying = next
