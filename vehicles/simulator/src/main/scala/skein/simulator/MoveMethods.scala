package skein.simulator

import skein.airsim.wire.*
import skein.units.*
import skein.vehicle.Setpoint

/** Functions that move one vehicle, and answer when the move ends. Angles are in radians for roll and pitch,
  * in degrees for yaw modes and rotations, as in AirSim.
  */
private[simulator] object MoveMethods extends MethodList:

  many[(Float, String)]("takeoff"):
    case (simulation, (timeout, name)) => fly(simulation, name)(PathMove.takeoff(timeout))
  many[(Float, String)]("land"):
    case (simulation, (timeout, name)) => fly(simulation, name)(Move.land(timeout))
  many[(Float, String)]("goHome"):
    case (simulation, (timeout, name)) =>
      fly(simulation, name)(PathMove.order(Seq(Vector3.Zero), 0.5f, timeout, Travel.Plain))
  one[String]("hover"): (simulation, name) =>
    // AirSim sends it along a path to its own position, which ends immediately with false; then its goal
    // expires.
    fly(simulation, name)(_ => Right((_, _) => MoveProgress.Ended(false, None)))
  byVelocity("moveByVelocity", ifNone = true): (_, x, y, vz) =>
    Setpoint.velocity(x, y, vz)
  byVelocity("moveByVelocityZ", ifNone = false): (_, x, y, z) =>
    Setpoint.velocityZ(x, y, z)
  byVelocity("moveByVelocityBodyFrame", ifNone = true): (vehicle, x, y, vz) =>
    val (north, east) = turned(vehicle, x, y)
    Setpoint.velocity(north, east, vz)
  byVelocity("moveByVelocityZBodyFrame", ifNone = true): (vehicle, x, y, z) =>
    val (north, east) = turned(vehicle, x, y)
    Setpoint.velocityZ(north, east, z)
  many[(Float, Float, Float, Float, Float, Int, YawMode, Float, Float, String)]("moveToPosition"):
    case (simulation, (x, y, z, speed, timeout, drivetrain, yaw, lookahead, adaptive, name)) =>
      val travel = Travel(drivetrain, yaw, lookahead, adaptive)
      fly(simulation, name)(PathMove.order(Seq(Vector3(x, y, z)), speed, timeout, travel))
  // In single precision, as in AirSim: a goal deviates by up to 0.4 m from the intended one.
  many[(Float, Float, Float, Float, Float, Int, YawMode, Float, Float, String)]("moveToGPS"):
    case (
          simulation,
          (latitude, longitude, altitude, speed, timeout, drivetrain, yaw, lookahead, adaptive, name)
        ) =>
      val travel = Travel(drivetrain, yaw, lookahead, adaptive)
      Argument.misplaced(latitude, longitude, altitude).fold(
        fly(simulation, name): vehicle =>
          val there = GeoLocation(latitude, longitude, Metres(altitude)).nedFrom(vehicle.home)
          PathMove.order(Seq(there), speed, timeout, travel)(vehicle)
      )(CallOutcome.Threw(_))
  many[(Seq[Vector3r], Float, Float, Int, YawMode, Float, Float, String)]("moveOnPath"):
    case (simulation, (path, speed, timeout, drivetrain, yaw, lookahead, adaptive, name)) =>
      val travel = Travel(drivetrain, yaw, lookahead, adaptive)
      fly(simulation, name)(PathMove.order(path.map(_.toVector), speed, timeout, travel))
  many[(Float, Float, Float, YawMode, Float, Float, String)]("moveToZ"):
    case (simulation, (z, speed, timeout, yaw, lookahead, adaptive, name)) =>
      val travel = Travel(0, yaw, lookahead, adaptive)
      fly(simulation, name): vehicle =>
        PathMove.order(Seq(vehicle.state.positionNed.copy(z = z)), speed, timeout, travel)(vehicle)
  many[(Float, Float, Float, String)]("rotateToYaw"):
    case (simulation, (yaw, timeout, margin, name)) =>
      fly(simulation, name)(Move.rotate(yaw, timeout, margin))
  many[(Float, Float, String)]("rotateByYawRate"):
    case (simulation, (rate, duration, name)) =>
      fly(simulation, name)(Move.hold(duration)(vehicle =>
        Move.withYaw(Setpoint.hold(vehicle.state.positionNed), YawMode(true, rate))
      ))
  many[(Float, Float, Float, Float, Int, YawMode, String)]("moveByManual"):
    case (simulation, (speedX, speedY, down, duration, drivetrain, yaw, name)) =>
      fly(simulation, name)(ManualMove.order(speedX, speedY, down, duration, drivetrain, yaw))
  byAngles("moveByRollPitchYawZ")(Setpoint.anglesZ)
  byAngles("moveByRollPitchYawThrottle")(Setpoint.anglesThrottle)
  byAngles("moveByRollPitchYawrateZ"): (roll, pitch, rate, z) =>
    Setpoint.anglesZ(roll, pitch, 0, z).withYawRate(rate)
  byAngles("moveByRollPitchYawrateThrottle"): (roll, pitch, rate, throttle) =>
    Setpoint.anglesThrottle(roll, pitch, 0, throttle).withYawRate(rate)
  byAngles("moveByAngleRatesZ")(Setpoint.ratesZ)
  byAngles("moveByAngleRatesThrottle")(Setpoint.ratesThrottle)
  byAngles("moveByMotorPWMs")(Setpoint.rotors)

  private def fly(simulation: Simulated, name: String)(order: Move.Order): CallOutcome =
    ServerMethod.multirotor(simulation, name)((index, _) => CallOutcome.Flies(index, order))

  private def byVelocity(method: String, ifNone: Boolean)(
      goal: (SimulatedMultirotor, Double, Double, Double) => Setpoint
  ): Unit =
    many[(Float, Float, Float, Float, Int, YawMode, String)](method):
      case (simulation, (x, y, third, duration, drivetrain, yaw, name)) =>
        fly(simulation, name)(Move.hold(duration, ifNone): vehicle =>
          val velocity = goal(vehicle, x, y, third)
          Move.withYaw(velocity, Move.facing(drivetrain, yaw, Vector3(velocity.first, velocity.second, 0))))

  private def byAngles(method: String)(goal: (Double, Double, Double, Double) => Setpoint): Unit =
    many[(Float, Float, Float, Float, Float, String)](method):
      case (simulation, (first, second, third, fourth, duration, name)) =>
        fly(simulation, name)(Move.hold(duration)(_ => goal(first, second, third, fourth)))

  /** Rotates a velocity to the front and right by the current heading, to north and east. */
  private def turned(vehicle: SimulatedMultirotor, front: Double, right: Double): (Double, Double) =
    val yaw = vehicle.state.yawRad
    (
      front * StrictMath.cos(yaw) - right * StrictMath.sin(yaw),
      front * StrictMath.sin(yaw) + right * StrictMath.cos(yaw)
    )
