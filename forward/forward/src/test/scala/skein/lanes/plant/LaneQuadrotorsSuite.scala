package skein.lanes.plant

import skein.units.Vector3
import skein.vehicle.{Airframe, CascadeGains, ControllerGains, Quadrotor, Setpoint}

class LaneQuadrotorsSuite extends munit.FunSuite:
  private val vehicles = LaneQuadrotors.VEHICLES

  private def downM(vehicle: Int) = -5.0 - vehicle * 0.2

  /** The velocity commanded to a vehicle, up to 10 m/s: new every 0.3 s, and different for every vehicle. */
  private def velocity(vehicle: Int, turn: Int): (Float, Float) =
    val speed = 2 + (vehicle * 7 + turn * 3) % 9
    val angle = 0.9 * vehicle + 0.35 * turn
    ((speed * math.cos(angle)).toFloat, (speed * math.sin(angle)).toFloat)

  test("the kernel's flight stays within 5 mm and 5 mm/s of the scalar quadrotor's after 10 s of turns"):
    val kernel = LaneQuadrotors.of(Quadrotor.AirSim).fold(fail(_), identity)
    val states = Array.tabulate(vehicles)(v => Quadrotor.AirSim.hovering(Vector3(v, -v, downM(v))))
    for v <- 0 until vehicles do kernel.hover(v, Vector3(v, -v, downM(v)))
    for turn <- 0 until 33 do
      for v <- 0 until vehicles do
        val (north, east) = velocity(v, turn)
        kernel.command(v, north, east, downM(v).toFloat)
        val setpoint = Setpoint.velocityZ(north, east, downM(v))
        for _ <- 1 to 100 do Quadrotor.AirSim.step(states(v), setpoint)
      kernel.fly(100)
    for v <- 0 until vehicles do
      val position = (kernel.positionNed(v) - states(v).positionNed).norm
      val speed    = (kernel.velocityNed(v) - states(v).velocityNed).norm
      assert(position < 5e-3, s"vehicle $v is $position m off")
      assert(speed < 5e-3, s"vehicle $v is $speed m/s off")

  test("another airframe with other gains flies as its scalar quadrotor does, within 2 mm after 3 s"):
    val heavy  = Quadrotor(Airframe(massKg = 1.3, dragCoefficient = 0.5), ControllerGains(velocityP = 0.3))
    val kernel = LaneQuadrotors.of(heavy).fold(fail(_), identity)
    val states = Array.tabulate(vehicles)(v => heavy.hovering(Vector3(0, 0, downM(v))))
    for v <- 0 until vehicles do
      val (north, east) = velocity(v, 1)
      kernel.hover(v, Vector3(0, 0, downM(v)))
      kernel.command(v, north, east, downM(v).toFloat)
      for _ <- 1 to 1000 do heavy.step(states(v), Setpoint.velocityZ(north, east, downM(v)))
    kernel.fly(1000)
    for v <- 0 until vehicles do
      val off = (kernel.positionNed(v) - states(v).positionNed).norm
      assert(off < 2e-3, s"vehicle $v is $off m off")

  test("a kernel that flies only some of its vehicles gives them equal results, to the bit"):
    val Vector(all, some) = Vector.fill(2)(LaneQuadrotors.of(Quadrotor.AirSim).fold(fail(_), identity))
    some.use(3)
    for kernel <- Seq(all, some) do
      for v <- 0 until 3 do
        kernel.hover(v, Vector3(0, 0, -20))
        kernel.command(v, 3, v.toFloat, -20)
      kernel.fly(333)
    for v <- 0 until 3 do assertEquals(some.positionNed(v), all.positionNed(v))

  test("gains that a client has set need more memory than SIMD stores, which is reported"):
    val told = LaneQuadrotors.of(Quadrotor.AirSim.tuned(CascadeGains.Default)).left.getOrElse("none")
    assert(told.contains("cascadeMemory"), told)

  test("a hovering vehicle holds its position to a millimetre over 30 s, in floats too"):
    val kernel = LaneQuadrotors.of(Quadrotor.AirSim).fold(fail(_), identity)
    for v <- 0 until vehicles do kernel.hover(v, Vector3(0, 0, -20))
    val start = kernel.positionNed(0)
    kernel.fly(10000)
    for v <- 0 until vehicles do assert((kernel.positionNed(v) - start).norm < 1e-3, kernel.positionNed(v))
