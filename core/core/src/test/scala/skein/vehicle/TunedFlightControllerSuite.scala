package skein.vehicle

import skein.units.Vector3

class TunedFlightControllerSuite extends munit.FunSuite:
  private val plain = Quadrotor.AirSim
  private val start = Vector3(0, 0, -20)

  private def flown(quadrotor: Quadrotor, setpoints: Seq[(Setpoint, Double)]): QuadrotorState =
    val state = plain.hovering(start)
    state.restartController()
    for (setpoint, seconds) <- setpoints; _ <- 0 until (seconds / quadrotor.stepS).round.toInt do
      quadrotor.step(state, setpoint)
    state

  private def place(state: QuadrotorState) =
    Seq(state.x, state.y, state.z, state.vx, state.vy, state.vz, state.qw, state.qx, state.qy, state.qz)

  private val tour = Seq(
    Setpoint.velocity(5, 2, -1)                      -> 3.0,
    Setpoint.velocityZ(0, 5, -25).withYaw(1)         -> 3.0,
    Setpoint.anglesZ(0.1, -0.1, 0.5, -22)            -> 1.0,
    Setpoint.rotors(0.6, 0.6, 0.6, 0.6)              -> 0.3,
    Setpoint.ratesThrottle(0.1, 0.1, 0.2, 0.6)       -> 0.3,
    Setpoint.hold(Vector3(14, 25, -22)).withYaw(0.3) -> 5.0
  )

  test("with the default gains the results equal those of the plain controller, to the last bit"):
    assertEquals(place(flown(plain.tuned(CascadeGains.Default), tour)), place(flown(plain, tour)))

  test("each gain changes the flight, except the rate controllers' integral and derivative, as in AirSim"):
    val default        = place(flown(plain.tuned(CascadeGains.Default), tour))
    def more(pid: Pid) = Seq(pid.copy(p = pid.p * 1.2), pid.copy(i = pid.i + 0.1), pid.copy(d = pid.d + 0.01))
    def each(axes: AxisGains) =
      more(axes.first).map(pid => axes.copy(first = pid)) ++
        more(axes.second).map(pid => axes.copy(second = pid)) ++
        more(axes.third).map(pid => axes.copy(third = pid))
    val base     = CascadeGains.Default
    val changing = each(base.angle).map(axes => base.copy(angle = axes)) ++
      each(base.velocity).map(axes => base.copy(velocity = axes)) ++
      each(base.position).map(axes => base.copy(position = axes))
    for gains <- changing do assertNotEquals(place(flown(plain.tuned(gains), tour)), default, gains.toString)
    val (proportional, others) =
      each(base.rate).partition(axes => !Seq(axes.first, axes.second, axes.third).forall(_.p == 0.25))
    for axes <- proportional do
      assertNotEquals(place(flown(plain.tuned(base.copy(rate = axes)), tour)), default, axes.toString)
    for axes <- others do
      assertEquals(place(flown(plain.tuned(base.copy(rate = axes)), tour)), default, axes.toString)

  test("a greater velocity gain responds to a velocity command faster"):
    def speedAfterHalfASecond(p: Double) =
      val gains = CascadeGains.Default.copy(velocity = AxisGains(Pid(p), Pid(0.2), Pid(2, 2)))
      flown(plain.tuned(gains), Seq(Setpoint.velocity(5, 0, 0) -> 0.5)).vx
    assert(speedAfterHalfASecond(0.1) < speedAfterHalfASecond(0.2) * 0.8)
    assert(speedAfterHalfASecond(0.2) < speedAfterHalfASecond(0.4))

  test("an integral gain of the velocity removes the error that drag causes"):
    def speedAfter30s(i: Double) =
      val gains = CascadeGains.Default.copy(velocity = AxisGains(Pid(0.2, i), Pid(0.2), Pid(2, 2)))
      flown(plain.tuned(gains), Seq(Setpoint.velocity(5, 0, 0) -> 30.0)).vx
    assertEqualsDouble(speedAfter30s(0), 4.86, 0.05)
    assertEqualsDouble(speedAfter30s(0.05), 5.0, 0.02)

  test("a copied state has its own memory"):
    val quadrotor =
      plain.tuned(CascadeGains.Default.copy(velocity = AxisGains(Pid(0.2, 0.05), Pid(0.2), Pid(2, 2))))
    val state = flown(quadrotor, Seq(Setpoint.velocity(5, 0, 0) -> 2.0))
    val copy  = QuadrotorState()
    copy.copyFrom(state)
    for _ <- 0 until 100 do quadrotor.step(copy, Setpoint.velocity(-5, 0, 0))
    val again = QuadrotorState()
    again.copyFrom(state)
    for _ <- 0 until 500 do
      quadrotor.step(state, Setpoint.velocity(5, 0, 0))
      quadrotor.step(again, Setpoint.velocity(5, 0, 0))
    assertEquals(place(again), place(state))
