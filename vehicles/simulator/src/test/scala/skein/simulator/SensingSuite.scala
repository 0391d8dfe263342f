package skein.simulator

import scala.collection.mutable.ArrayBuffer
import skein.airsim.wire.*
import skein.mavlink.*
import skein.units.*
import skein.vehicle.SensorNoise
import upack.{Bool, Str}

/** Readings with errors, as clients of each protocol see them. */
class SensingSuite extends munit.FunSuite:
  private val name = "Evader"

  private final class Client(text: String, told: TruePosition => Unit = _ => ()):
    val bench =
      Bench(sensing = Some(SimulatedSensing(SensorNoise.parse(text).fold(fail(_), identity), 7, told)))
    bench.tell("enableApiControl", Bool(true), Str(name))
    bench.tell(
      "skeinHoverAt",
      upickle.default.writeMsg(Pose(Vector3r(3, 4, -20), Quaternionr(Quaternion.Identity))),
      Str(name)
    )

    def state: MultirotorState = bench.now[MultirotorState]("getMultirotorState", Str(name))
    def truth: KinematicsState = bench.now[KinematicsState]("simGetGroundTruthKinematics", Str(name))

    /** Runs until sensors have no reading. */
    def untilMissing(): Unit =
      var tries = 0
      while !state.skein_missing && tries < 10_000 do
        bench.pass(0.02)
        tries += 1
      assert(state.skein_missing)

  private def off(one: Vector3r, other: Vector3r) = (one.toVector - other.toVector).norm

  test("the state and GPS have errors, equal ones at one instant, and the ground truth has none"):
    val sensed = Client("position=0.5,velocity=0.1,heading=0.1,drift=2/60s")
    sensed.bench.pass(2)
    val (state, again, truth) = (sensed.state, sensed.state, sensed.truth)
    val gps                   = sensed.bench.now[GpsData]("getGpsData", Str(""), Str(name))
    assertEquals(again, state)
    assertEquals(off(truth.position, Vector3r(3, 4, -20)) < 0.1, true)
    assert(off(state.kinematics_estimated.position, truth.position) > 0.1)
    assert(off(state.kinematics_estimated.linear_velocity, truth.linear_velocity) > 0.01)
    assert(state.kinematics_estimated.orientation.toQuaternion.yawRad.abs > 0.005)
    assertEquals(gps.gnss.velocity, state.kinematics_estimated.linear_velocity)
    assertEquals(gps.gnss.geo_point, state.gps_location)

  test("during an outage the state is the last one with its time stamp, and is marked"):
    val sensed = Client("position=0.5,outage=1s/20s")
    sensed.untilMissing()
    val last = sensed.state
    sensed.bench.pass(0.3)
    assertEquals(sensed.state, last)
    assert(last.timestamp < sensed.bench.simulation.world.now)
    sensed.bench.pass(1)
    assert(!sensed.state.skein_missing)
    assertEquals(sensed.state.timestamp, sensed.bench.simulation.world.now)

  test("while the simulator is paused there is always a reading"):
    val sensed = Client("outage=1s/3s")
    sensed.untilMissing()
    sensed.bench.tell("simPause", Bool(true))
    assert(!sensed.state.skein_missing)
    assertEquals(sensed.state.timestamp, sensed.bench.simulation.world.now)

  test("during an outage MAVLink and onlookers are sent no motion"):
    val sensed  = Client("outage=1s/3s")
    val seen    = ArrayBuffer.empty[(at: Instant, vehicles: Vector[SeenVehicle])]
    val mavlink = MavlinkVehicles(sensed.bench.simulation, MavlinkSettings())
    val reader  = FrameReader()
    mavlink.join(0, Vector.empty, isDatagrams = false)
    val _ = InProcess(sensed.bench.simulation, (at, vehicles) => seen += ((at = at, vehicles = vehicles)))
    def heard() = mavlink.take().flatMap(_.datagrams).flatMap(bytes => reader.read(bytes)).map(_.message)
    // What each 50 ms brought, and whether sensors had a reading at their end.
    val spans = (1 to 400).map: _ =>
      seen.clear()
      sensed.bench.pass(0.05)
      (sensed.state.skein_missing, heard(), seen.exists(_.vehicles.nonEmpty))
    // The first span of an outage, and the first after it, are of both kinds.
    val clear = spans.zip(spans.tail).collect { case (before, now) if before._1 == now._1 => now }
    assert(clear.exists(_._1) && clear.exists(!_._1))
    assert(clear.filter(_._1).forall((_, messages, isSeen) =>
      !isSeen && !messages.exists(_.isInstanceOf[LocalPositionNed])
    ))
    assert(clear.filterNot(_._1).forall(_._3))
    assert(clear.filter(_._1).exists(_._2.exists(_.isInstanceOf[Heartbeat])))
    assert(clear.filterNot(_._1).exists(_._2.exists(_.isInstanceOf[LocalPositionNed])))

  test("MAVLink answers requests by readings, and refuses them during an outage"):
    val sensed  = Client("position=5,outage=1s/3s")
    val mavlink = MavlinkVehicles(sensed.bench.simulation, MavlinkSettings())
    mavlink.join(0, Vector.empty, isDatagrams = false)
    val (reader, writer) = (FrameReader(), FrameWriter(system = 245, component = 190))
    // Its result, and the position if it is answered.
    def requested() =
      val _ = mavlink.take()
      mavlink.receive(0, writer.write(CommandLong(1, 1, 512, 0, 32, 0, 0, 0, 0, 0, 0)))
      val heard = mavlink.take().flatMap(_.datagrams).flatMap(bytes => reader.read(bytes)).map(_.message)
      val ack   = heard.collectFirst { case ack: CommandAck => ack.result }
      val after = heard.dropWhile(!_.isInstanceOf[CommandAck])
      (ack, after.collectFirst { case it: LocalPositionNed => Vector3(it.x, it.y, it.z) })
    sensed.untilMissing()
    assertEquals(requested(), (Some(1), None))
    while sensed.state.skein_missing do sensed.bench.pass(0.1)
    val seen            = sensed.state.kinematics_estimated.position.toVector
    val (result, place) = requested()
    assertEquals(result, Some(0))
    assert(place.exists(place => (place - seen).norm < 1e-4), s"$place, $seen")

  test("clients read which errors there are"):
    assertEquals(Client("position=1").bench.now[String]("skeinSensors"), "position=1")
    assertEquals(Bench().now[String]("skeinSensors"), "")

  test("the truth is told every 50 ms of simulated time, to a step of physics"):
    val told   = ArrayBuffer.empty[TruePosition]
    val sensed = Client("position=5", one => told += one: Unit)
    val start  = sensed.bench.simulation.world.now - Span.ofSeconds(sensed.bench.simulatedS)
    told.clear()
    sensed.bench.pass(3)
    assertEquals(told.map(_.vehicle).toSet, Set(name))
    assertEqualsDouble(told.size.toDouble, 59, 2)
    assert(told.map(_.at.toNanos).sliding(2).forall(pair => pair(1) - pair(0) <= 54_000_000L))
    assert(told.forall(one => (one.positionNed - Vector3(3, 4, -20)).norm < 0.1))
    assert(told.forall(one => one.sinceStart == one.at.since(start)))
