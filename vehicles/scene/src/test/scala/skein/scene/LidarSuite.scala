package skein.scene

import skein.units.Vector3

class LidarSuite extends munit.FunSuite:
  private val sixty = Scenes.Sixty

  private def scan(lidar: Lidar, at: Placement, moment: Moment = sixty, count: Long = 0) =
    lidar.scan(moment, at, Item.Nothing, Vector3.Zero, count)

  test(
    "AirSim's default lidar sees flat ground in 16 circles of 10,000 points per turn, less the last degree"
  ):
    val points = scan(Lidar(), Placement(Vector3(0, 0, -10)), Moment(Scene.Empty, Vector.empty))
    assertEquals(points.items.toSet, Set(Item.Ground))
    val radii = points.xyz.grouped(3).map(p => math.hypot(p(0), p(1))).toSeq
    assertEqualsDouble(radii.max, 10 / math.tan(math.toRadians(15)), 1e-3)
    assertEqualsDouble(radii.min, 10 / math.tan(math.toRadians(45)), 1e-3)
    assertEquals(radii.map(r => math.round(r * 1000)).distinct.size, 16)
    assert(points.items.length > 9900 && points.items.length < 10_000, s"${points.items.length}")

  test("a ray hits the nearest of all bodies, wherever the lidar is"):
    val level = Lidar(verticalFovDeg = (-30, 30), rangeM = 200)
    for seed <- 1 to 5 do
      val moment = Moment(Scenes.boxes(40, seed), Vector.empty)
      val place  = Placement.turned(Vector3(seed * 6, seed * 3 - 8, -3), 10, -5, seed * 50)
      val points = scan(level, place, moment)
      for i <- points.items.indices by 37 do
        val at   = Vector3(points.xyz(3 * i), points.xyz(3 * i + 1), points.xyz(3 * i + 2))
        val way  = at - place.position
        val unit = way * (1 / way.norm)
        val met  = moment.solids.map(_.hit(
          place.position.x,
          place.position.y,
          place.position.z,
          unit.x,
          unit.y,
          unit.z,
          200
        ))
        val ground = if unit.z > 0 then -place.position.z / unit.z else Double.PositiveInfinity
        assertEqualsDouble(way.norm, math.min(met.min, ground), 1e-3)

  test("points in the sensor's frame are the world's points, transformed"):
    val place = Placement.turned(Vector3(3, -2, -4), 5, 10, 120)
    val world = scan(Lidar(place = Placement(Vector3(0, 0, 0.1))), place)
    val own   = scan(Lidar(place = Placement(Vector3(0, 0, 0.1)), sensorFrame = true), place)
    val where = place.outside(Placement(Vector3(0, 0, 0.1)))
    assertEquals(own.items.toSeq, world.items.toSeq)
    for i <- own.items.indices by 101 do
      def point(xyz: Array[Float]) = Vector3(xyz(3 * i), xyz(3 * i + 1), xyz(3 * i + 2))
      assert((where.outside(point(own.xyz)) - point(world.xyz)).norm < 1e-3)

  test("range noise has the configured standard deviation, and differs between scans"):
    val noisy                        = Lidar(noiseM = 0.05, seed = 3, sensorFrame = true)
    val exact                        = Lidar(sensorFrame = true)
    val place                        = Placement(Vector3(0, 0, -5))
    def ranges(points: Lidar.Points) =
      points.xyz.grouped(3).map(p => math.sqrt(p.map(x => x.toDouble * x).sum)).toSeq
    val off = ranges(scan(noisy, place)).zip(ranges(scan(exact, place))).map(_ - _)
    assertEqualsDouble(math.sqrt(off.map(x => x * x).sum / off.size), 0.05, 0.002)
    assert(scan(noisy, place).xyz.sameElements(scan(noisy, place).xyz))
    assert(!scan(noisy, place).xyz.sameElements(scan(noisy, place, count = 1).xyz))

  test("a narrow field of view has points in every scan"):
    val narrow = scan(Lidar(horizontalFovDeg = (-20, 20)), Placement(Vector3(0, 0, -10)))
    assert(narrow.items.length > 1000)
    for p <- narrow.xyz.grouped(3) do assert(math.abs(math.toDegrees(math.atan2(p(1), p(0)))) < 20.01)

  test("a field of view from an angle to itself is the whole turn"):
    for fov <- Seq((0.0, 0.0), (0.0, 360.0), (90.0, 90.0)) do
      val lidar = Lidar(channels = 1, horizontalFovDeg = fov, verticalFovDeg = (-30, -30))
      assertEquals(scan(lidar, Placement(Vector3(0, 0, -10))).items.length, lidar.rays, fov)
