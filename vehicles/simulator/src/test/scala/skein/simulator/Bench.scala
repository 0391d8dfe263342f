package skein.simulator

import skein.rpc.{Encoded, RpcRequest}
import skein.airsim.wire.*
import skein.airsim.{VehicleSettings, WorldSettings}
import skein.scene.Scene
import skein.units.*
import upack.{Bool, Float32, Float64, Int32, Msg, Str}
import upickle.default.{Reader, readBinary, writeMsg}

/** A simulator under test: calls go in at stated times, answers are kept with their times. */
final private[skein] class Bench(
    vehicles: Seq[String] = Seq("Evader"),
    settings: Seq[VehicleSettings] = Seq.empty,
    overload: Overload = Overload.AirSim,
    speed: Double = 1.0,
    scene: Scene = Scene.Empty,
    text: String = "{}",
    patience: Option[Span] = None,
    sensing: Option[SimulatedSensing] = None
):
  private val start = Instant.ofNanos(1_000_000_000L)

  val simulation: Simulation = Simulation(
    SimulatorSettings(
      WorldSettings(
        if settings.isEmpty then vehicles.map(VehicleSettings(_)).toVector
        else settings.toVector,
        text = text
      ),
      overload = overload,
      speed = speed,
      scene = scene,
      patience = patience,
      sensing = sensing
    ),
    start
  )
  private var clock     = start
  private var nextToken = 0L
  private val answers   = scala.collection.mutable.Map.empty[Long, (Double, Either[String, Msg])]

  /** Seconds since the start, by the clock that drives the simulator. */
  def elapsedS: Double = clock.since(start).toSeconds

  /** Seconds since the start, by the simulator's own clock. */
  def simulatedS: Double = simulation.world.now.since(start).toSeconds

  /** Makes a call now; the returned token identifies the answer. */
  def call(method: String, params: Msg*): Long = callBy(0)(method, params*)

  /** Makes a call as the client with this number. */
  def callBy(client: Long)(method: String, params: Msg*): Long =
    val token = nextToken
    nextToken += 1
    simulation.receive(SimulatorCall(token, RpcRequest(client, method, params.toVector, false)), clock)
    collect()
    token

  /** Ends a client's stream of calls. */
  def depart(client: Long): Unit =
    simulation.depart(client, isForgotten = false, clock)
    collect()

  /** Makes a call that must be answered immediately. */
  def now[A: Reader](method: String, params: Msg*): A =
    answerOf(call(method, params*)).fold(text => throw AssertionError(text), readBinary[A](_))

  def tell(method: String, params: Msg*): Unit =
    val _ = answerOf(call(method, params*)).fold(text => throw AssertionError(text), identity)

  def error(method: String, params: Msg*): String =
    answerOf(call(method, params*)).swap.getOrElse(throw AssertionError(s"$method did not fail"))

  /** Advances time, waking the simulator when it requests it. */
  def pass(seconds: Double): Unit =
    val until = clock + Span.ofSeconds(seconds)
    var wake  = simulation.nextWake(clock).filter(_ <= until)
    while wake.nonEmpty do
      clock = wake.get
      simulation.advance(clock)
      collect()
      wake = simulation.nextWake(clock).filter(_ <= until)
    clock = until
    simulation.advance(clock)
    collect()

  def isAnswered(token: Long): Boolean = answers.contains(token)

  /** When a call was answered, s since the start; None if it has not been. */
  def answeredAt(token: Long): Option[Double] = answers.get(token).map(_._1)

  private def decoded(value: Msg | Encoded): Msg = value match
    case Encoded(bytes) => upack.read(bytes.toArray)
    case value: Msg     => value

  def answerOf(token: Long): Either[String, Msg] =
    answers.getOrElse(token, throw AssertionError(s"call $token has no answer yet"))._2

  def result(token: Long): Option[Boolean] = answers.get(token).map(_._2).collect { case Right(Bool(value)) =>
    value
  }

  /** Arms all vehicles under API control. */
  def ready(): Bench =
    vehicles.foreach: name =>
      tell("enableApiControl", Bool(true), Str(name))
      tell("armDisarm", Bool(true), Str(name))
    this

  /** Lets all vehicles hover at rest in the air. */
  def hovering(down: Double): Bench =
    ready()
    for (name, i) <- vehicles.zipWithIndex do
      val pose = Pose(Vector3r(Vector3(0, i * 10.0, down)), Quaternionr(Quaternion.Identity))
      tell("skeinHoverAt", writeMsg(pose), Str(name))
    this

  def velocityZ(
      vx: Double,
      vy: Double,
      z: Double,
      durationS: Double,
      name: String = "Evader",
      client: Long = 0
  ): Long =
    callBy(client)(
      "moveByVelocityZ",
      real(vx),
      real(vy),
      real(z),
      real(durationS),
      Int32(0),
      writeMsg(YawMode.Still),
      Str(name)
    )

  def velocity(vx: Double, vy: Double, vz: Double, durationS: Double, name: String = "Evader"): Long =
    call(
      "moveByVelocity",
      real(vx),
      real(vy),
      real(vz),
      real(durationS),
      Int32(0),
      writeMsg(YawMode.Still),
      Str(name)
    )

  def moveTo(x: Double, y: Double, z: Double, speed: Double): Long =
    call(
      "moveToPosition",
      real(x),
      real(y),
      real(z),
      real(speed),
      real(3e38),
      Int32(0),
      writeMsg(YawMode.Still),
      real(-1),
      real(1),
      Str("")
    )

  def continueFor(seconds: Double): Long = call("simContinueForTime", Float64(seconds))

  def kinematics(name: String = "Evader"): KinematicsState =
    now[KinematicsState]("simGetGroundTruthKinematics", Str(name))
  def position(name: String = "Evader"): Vector3 = kinematics(name).position.toVector
  def stamp(name: String = "Evader"): Instant    =
    now[MultirotorReading]("getMultirotorState", Str(name)).timestamp

  def real(value: Double): Msg = Float32(value.toFloat)

  private def collect(): Unit =
    for SimulatorAnswer(token, result) <- simulation.takeAnswers() do
      answers(token) = (
        elapsedS,
        result.map:
          case drawing: DeferredResult => decoded(drawing.result())
          case value: (Msg | Encoded)  => decoded(value)
      )

private[skein] object Bench:
  def of(vehicles: VehicleSettings*): Bench = Bench(vehicles.map(_.name), vehicles)
