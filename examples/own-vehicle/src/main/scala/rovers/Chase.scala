package rovers

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Future
import skein.cli.SkeinApp
import skein.flight.PortFlight
import skein.forecast.Structure
import skein.link.{LinkProfile, MemoryNetwork, NetworkPlan, TcpTransport, Transport}
import skein.loop.{LoopKind, LoopSettings, OwnLoop, PlanSettings}
import skein.policy.*
import skein.record.{ClockKind, MemoryRecorder, Recorder}
import skein.scenario.*
import skein.settings.PredictionModel
import skein.signal.LatencyProfile
import skein.units.*
import skein.vtime.VirtualTime

/** Drives from corner to corner; remembers which is the next. */
final case class Patrol(corners: Vector[Vector3], mps: Double) extends Policy:
  type Memory = Int
  def start: Int                                            = 0
  def choose(seen: Observation, memory: Int): (Action, Int) =
    val here = seen.own.kinematics.positionNed
    val next = if here.horizontalDistance(corners(memory)) < 1 then (memory + 1) % corners.size else memory
    val way  = corners(next) - here
    val mps  = this.mps / way.norm.max(1e-9)
    (Action.VelocityAt(way.x * mps, way.y * mps, Metres(0)), next)

/** Drives towards another vehicle, slower the nearer it is, and stops at a distance. As a goal for planning,
  * it keeps that distance behind the other.
  *
  * @param leader its index in the scenario
  */
final case class Heel(leader: Int, distanceM: Double, mostMps: Double) extends Policy, Goal:
  type Memory = Unit
  def start: Unit                                             = ()
  def choose(seen: Observation, memory: Unit): (Action, Unit) =
    val north = seen.northM(leader) - seen.northM(seen.self)
    val east  = seen.eastM(leader) - seen.eastM(seen.self)
    val way   = StrictMath.hypot(north, east)
    val speed = (way - distanceM).max(0) / way.max(1e-9)
    (seen.towards(north * speed, east * speed, mostMps), ())

  def wanted(seen: Observation, aheadS: Double): (Double, Double) =
    val (north, east) = (seen.northMps(leader), seen.eastMps(leader))
    val sinceS        = aheadS - distanceM / StrictMath.hypot(north, east).max(0.1)
    (seen.northM(leader) + north * sinceS, seen.eastM(leader) + east * sinceS)

/** Two robots: one patrols, the other follows closely. */
final case class Rovers(hareMps: Double = 1.5, houndMps: Double = 3) extends Scenario:
  private val corners = Vector(Vector3(12, 0, 0), Vector3(12, 8, 0), Vector3(0, 8, 0), Vector3(0, 0, 0))

  def agents: Vector[Agent] =
    val (hare, hound) = (MetresPerSecond(hareMps), MetresPerSecond(houndMps))
    Vector(
      Agent("Hare", Role.Evader, hare, Vector3(4, 0, 0), Radians(0), Patrol(corners, hareMps)),
      Agent("Hound", Role.Pursuer, hound, Vector3(-4, -4, 0), Radians(0), Heel(leader = 0, 1, houndMps))
    )

  private val distance = Series("distance", "m")(tracks => tracks.distanceM(0, 1, _))

  override def series: Vector[Series]    = Vector(distance)
  override def measures: Vector[Measure] =
    Vector(distance.mean("last 10 s", Window.Last(10)), distance.least("closest"))

/** All of Skein's commands, with the scenario and the structure of the robots' plant. */
object Program extends SkeinApp(ScenarioKind(Rovers())):
  override def structures: Seq[Structure] = Seq(RoverPlant.structure)

/** Runs drives, live and in virtual time. */
object Chase:
  /** The prediction model that equals the simulator's model. */
  val rover: PredictionModel = PredictionModel.Own(RoverPlant.structure, Vector(3, 1.5, 0.4, 0))

  /** Settings for planning: one search suffices for one robot. */
  val planning: PlanSettings = PlanSettings(searches = 1)

  def flight(
      loop: LoopKind | OwnLoop,
      duration: Span,
      clockKind: ClockKind,
      clock: Clock,
      predictor: PredictionModel = rover,
      scenario: Scenario = Rovers()
  ): PortFlight =
    PortFlight(
      s"${loop.label}-rovers${if clockKind == ClockKind.Virtual then "-virtual" else ""}",
      loop,
      scenario,
      duration,
      clockKind,
      clock,
      LoopSettings.every(Span.ofMillis(100)).copy(planning = planning),
      simulator = "rovers",
      predictor = Some(predictor)
    )

  /** Runs a drive: simulated robots listen at one host, the loop connects from another. */
  private def drive(
      flight: PortFlight,
      robots: (Transport, String),
      here: Transport,
      recorder: Recorder
  )(using
      system: ActorSystem
  ) =
    import system.dispatcher
    val start = flight.clock.now()
    for
      addresses <- Future.traverse(flight.scenario.agents): agent =>
        val at = agent.startPositionNed
        RoverSimulator(at.x, at.y, flight.clock, start).listen(robots._1, robots._2)
      vehicles = addresses.map(Rover(here, _, flight.clock))
      landed <- flight.start(vehicles, recorder).landed
    yield landed

  /** Drives over TCP on loopback, in real time. */
  def live(loop: LoopKind | OwnLoop, duration: Span)(recorder: PortFlight => Future[Recorder])(using
      system: ActorSystem
  ) =
    import system.dispatcher
    val planned = flight(loop, duration, ClockKind.Real, Clock.system)
    recorder(planned).flatMap(drive(planned, (TcpTransport(), "127.0.0.1"), TcpTransport(), _))

  /** Drives in virtual time, without waiting, over a link. Equal seeds give equal recordings. */
  def virtual(
      loop: LoopKind | OwnLoop,
      duration: Span,
      seed: Long,
      link: LatencyProfile = LatencyProfile.none,
      predictor: PredictionModel = rover,
      scenario: Scenario = Rovers()
  ): MemoryRecorder = VirtualTime
    .run(seed): system =>
      given ActorSystem = system
      import system.dispatcher
      val clock    = Clock.ofNanos(VirtualTime.clock(system))
      val planned  = flight(loop, duration, ClockKind.Virtual, clock, predictor, scenario)
      val recorder = MemoryRecorder(planned.heading)
      val network  = MemoryNetwork(NetworkPlan(LinkProfile.symmetric(link)), seed, clock)
      drive(planned, (network.host("robots"), "robots"), network.host("control"), recorder).map(_ => recorder)
    .value
