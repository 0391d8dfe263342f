package skein.vehicle

import skein.units.Vector3

class DeviationSuite extends munit.FunSuite:

  test("a deviation is read, each part at most once and within its bounds"):
    assertEquals(
      Deviation.parse("mass=1.3,drag=2,lag=1.5,rotors=1/0.8/1/1,wind=8/-2/0,gusts=7.7,shear=0.05"),
      Right(Deviation(
        1.3,
        2,
        1.5,
        Vector(1, 0.8, 1, 1),
        Wind(Vector3(8, -2, 0), 7.7, 0.05)
      ))
    )
    def mistake(text: String) = Deviation.parse(text).left.getOrElse(fail(s"$text is read"))
    assertEquals(mistake("mass=2"), "expected a number from 0.5 to 1.6, got 'mass=2'")
    assertEquals(mistake("lag=NaN"), "expected a number from 0.3 to 3.0, got 'lag=NaN'")
    assertEquals(mistake("wind=8"), "expected 3 numbers between /, got 'wind=8'")
    assertEquals(mistake("drag=2,drag=2"), "drag stands twice")
    assert(mistake("").endsWith("; got ''"))
    assert(mistake("weight=2").startsWith("expected mass=FACTOR, "))

  test("each factor changes only its own quantity"):
    val usual   = Quadrotor.AirSim
    val heavier = Deviation(mass = 1.3).quadrotor
    assertEqualsDouble(heavier.hoverControl(0), 1.3 * usual.hoverControl(0), 1e-12)
    assertEquals(heavier.airframe.dragFront, usual.airframe.dragFront)
    assertEqualsDouble(
      Deviation(drag = 2).quadrotor.airframe.dragDown,
      2 * usual.airframe.dragDown,
      1e-12
    )
    assertEqualsDouble(Deviation(lag = 2).quadrotor.gains.velocityP, usual.gains.velocityP / 2, 1e-12)
    assertEquals(Deviation().quadrotor.airframe, usual.airframe)

  test("without a deviation the vehicle flies exactly like AirSim's vehicle, to the bit"):
    val theirs   = Quadrotor.AirSim.hovering(Vector3(0, 0, -20))
    val ours     = theirs.copy
    val deviated = Deviation().kind(seed = 1).make()
    for step <- 1 to 2000 do
      val setpoint = Setpoint.velocityZ(if step % 700 < 350 then 5 else -3, 2, -20)
      Quadrotor.AirSim.step(theirs, setpoint, Environment.Calm)
      deviated.step(ours, setpoint, Environment.Calm)
    assertEquals(ours.kinematics, theirs.kinematics)

  test("a rotor with half of its thrust tips the vehicle over"):
    val weak  = Deviation(rotors = Vector(0.5, 1, 1, 1)).kind(seed = 1).make()
    val state = Quadrotor.AirSim.hovering(Vector3(0, 0, -20))
    for _ <- 1 to 300 do weak.step(state, Setpoint.hold(Vector3(0, 0, -20)), Environment.Calm)
    assert(
      state.positionNed.norm > 20.05 || state.kinematics.angularVelocityFrd.norm > 0.05,
      state.kinematics
    )
