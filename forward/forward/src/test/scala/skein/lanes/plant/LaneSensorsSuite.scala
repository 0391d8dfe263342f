package skein.lanes.plant

import skein.lanes.policy.LanePolicy
import skein.signal.{Kinematics, SplitMix64}
import skein.units.{Quaternion, Span, Vector3}
import skein.vehicle.{NoisySensor, SensorNoise}

class LaneSensorsSuite extends munit.FunSuite:
  private val worlds = LanePolicy.WORLDS
  private val still  = Kinematics(Vector3.Zero, Vector3.Zero, Quaternion.Identity, Vector3.Zero)
  private val noise  = SensorNoise.parse("position=0.3,velocity=0.1,drift=1.5/10s").fold(fail(_), identity)

  private def components(of: Kinematics) =
    Vector(of.positionNed, of.velocityNed).flatMap(part => Vector(part.x, part.y, part.z)).map(_.toFloat)

  private def expected(seed: Long, vehicle: Int, atNs: Long) =
    components(NoisySensor(noise, SplitMix64.seedOf(seed, vehicle)).read(still, Span.ofNanos(atNs)))

  test("errors equal the scalar sensor's, at times that differ from world to world and also go back"):
    val sensors = LaneSensors(noise, true)
    val random  = SplitMix64(3)
    val seeds   = Array.tabulate(worlds)(_.toLong * 77)
    sensors.start(seeds, 1, false)
    for beginNs <- Seq(0L, 50_000_000L, 4_000_000_000L, 3_000_000_000L, 21_000_000_000L) do
      val atNs = Array.tabulate(worlds)(world =>
        if world % 5 == 4 then -1 else beginNs + random.nextInt(900_000_000)
      )
      sensors.at(atNs, 0, worlds)
      for component <- 0 until 6 do
        val read = Array.fill(worlds + 2)(9f)
        sensors.add(component, atNs, 0, worlds, read, 2)
        for world <- 0 until worlds do
          val error = if atNs(world) < 0 then 0f else expected(seeds(world), 1, atNs(world))(component)
          assertEqualsFloat(read(world + 2) - 9, error, 2e-6f, s"world $world, component $component")

  test("worlds of one seed have equal errors at times of their own, whatever was read before"):
    val sensors = LaneSensors(noise, true)
    for seed <- Seq(8L, 5L) do
      sensors.start(Array.tabulate(worlds)(world => if seed == 5 then seed else seed + world), 0, false)
      val atNs = Array.fill(worlds)(7_654_321_000L)
      sensors.at(atNs, 0, worlds)
      for component <- 0 until 6 if seed == 5 do
        val read = Array.ofDim[Float](worlds)
        sensors.add(component, atNs, 0, worlds, read, 0)
        assertEquals(read.toVector, Vector.fill(worlds)(expected(5, 0, atNs(0))(component)))

  test("worlds of one seed have one error"):
    val sensors = LaneSensors(noise, true)
    sensors.start(Array.fill(worlds)(5L), 0, true)
    for atNs <- Seq(0L, 7_654_321_000L) do
      sensors.at(atNs)
      for component <- 0 until 6 do
        val read = Array.ofDim[Float](worlds)
        sensors.add(component, read, 0)
        assertEquals(read.toVector, Vector.fill(worlds)(expected(5, 0, atNs)(component)))
