package skein.vehicle

import skein.signal.Kinematics
import skein.units.{Span, Vector3}

/** The meaning of a setpoint's two horizontal goals, `first` and `second`. */
enum HorizontalMode:
  /** The four goals are the controls of the rotors, 0 to 1; roll and pitch are not controlled. */
  case Rotors

  /** Goals are roll rate and pitch rate, rad/s. */
  case Rates

  /** Goals are roll angle and pitch angle, rad. */
  case Angles

  /** Goals are the velocities north and east, m/s. */
  case Velocity

  /** Goals are the positions north and east, m. */
  case Position

/** The meaning of a setpoint's vertical goal, `third`. */
enum VerticalMode:
  /** The goal is the throttle of all rotors, 0 to 1. */
  case Throttle

  /** The goal is the velocity down, m/s, negative upwards. */
  case Velocity

  /** The goal is the position down (z of NED, negative above the origin), m. */
  case Position

/** The meaning of a setpoint's goal for yaw, `yawGoal`. */
enum YawMode:
  /** The goal is the yaw rate, rad/s, clockwise from above. */
  case Rate

  /** The goal is the yaw, rad from north towards east, reached by the shorter way. */
  case Angle

/** A command that may depend on the vehicle's state: it yields goals for the flight controller. A
  * [[Setpoint]] is a command that does not.
  */
trait Guidance:
  /** The goals at this state of the vehicle.
    *
    * @param now evaluated only if needed
    */
  def setpoint(now: => Kinematics): Setpoint

  /** Time after which new goals are needed; None if the goals never change. */
  def period: Option[Span]

/** Goals of the flight controller: a mode and a goal for each axis, as in AirSim's SimpleFlight. The
  * companion's methods have the names of AirSim's commands.
  *
  * @param first the goal of `horizontal`: roll (rad, rad/s) or north (m, m/s)
  * @param second the second goal of `horizontal`: pitch or east
  * @param third the goal of `vertical`
  * @param yawGoal the goal of `yaw`
  */
final case class Setpoint(
    horizontal: HorizontalMode,
    first: Double,
    second: Double,
    vertical: VerticalMode,
    third: Double,
    yaw: YawMode = YawMode.Rate,
    yawGoal: Double = 0.0
) extends Guidance:
  def setpoint(now: => Kinematics): Setpoint = this
  def period: Option[Span]                   = None

  /** This setpoint with a yaw as goal, rad from north. */
  def withYaw(yawRad: Double): Setpoint = copy(yaw = YawMode.Angle, yawGoal = yawRad)

  /** This setpoint with a yaw rate as goal, rad/s. */
  def withYawRate(yawRateRadps: Double): Setpoint = copy(yaw = YawMode.Rate, yawGoal = yawRateRadps)

object Setpoint:

  val Disarmed: Setpoint = Setpoint(HorizontalMode.Rates, 0, 0, VerticalMode.Throttle, 0)

  /** Idling motors: AirSim's throttle of an armed vehicle without goals, two thirds of the throttle above
    * which a vehicle counts as driven.
    */
  val Armed: Setpoint = Setpoint(HorizontalMode.Rates, 0, 0, VerticalMode.Throttle, 0.1 / 1.5)

  /** `moveByVelocity`: north, east, down, m/s. */
  def velocity(northMps: Double, eastMps: Double, downMps: Double): Setpoint =
    Setpoint(HorizontalMode.Velocity, northMps, eastMps, VerticalMode.Velocity, downMps)

  /** `moveByVelocityZ`: velocity north and east, m/s, at altitude `downM` (NED). The higher the vehicle
    * flies, the more slowly it responds than to [[velocity]]; [[FlightController]] explains why.
    */
  def velocityZ(northMps: Double, eastMps: Double, downM: Double): Setpoint =
    Setpoint(HorizontalMode.Velocity, northMps, eastMps, VerticalMode.Position, downM)

  /** Position hold: AirSim's `hover` at this position; also the goal after a command has expired that was not
    * renewed. The vehicle settles 2 mm below ([[Quadrotor.hoverSagM]]). As in AirSim, the hold weakens as the
    * yaw turns away from north: each axis takes only its own coordinate's error into the body frame, so at
    * ±90° it brakes but does not return.
    */
  def hold(positionNed: Vector3): Setpoint =
    Setpoint(
      HorizontalMode.Position,
      positionNed.x,
      positionNed.y,
      VerticalMode.Position,
      positionNed.z
    )

  /** `moveByRollPitchYawZ`: angles in rad, altitude `downM` (NED). */
  def anglesZ(rollRad: Double, pitchRad: Double, yawRad: Double, downM: Double): Setpoint =
    Setpoint(HorizontalMode.Angles, rollRad, pitchRad, VerticalMode.Position, downM).withYaw(yawRad)

  /** `moveByRollPitchYawThrottle`: angles in rad, throttle 0 to 1. */
  def anglesThrottle(rollRad: Double, pitchRad: Double, yawRad: Double, throttle: Double): Setpoint =
    Setpoint(HorizontalMode.Angles, rollRad, pitchRad, VerticalMode.Throttle, throttle).withYaw(yawRad)

  /** `moveByAngleRatesZ`: rates in rad/s, altitude `downM` (NED). */
  def ratesZ(rollRadps: Double, pitchRadps: Double, yawRadps: Double, downM: Double): Setpoint =
    Setpoint(HorizontalMode.Rates, rollRadps, pitchRadps, VerticalMode.Position, downM).withYawRate(yawRadps)

  /** `moveByAngleRatesThrottle`: rates in rad/s, throttle 0 to 1. */
  def ratesThrottle(
      rollRadps: Double,
      pitchRadps: Double,
      yawRadps: Double,
      throttle: Double
  ): Setpoint =
    Setpoint(
      HorizontalMode.Rates,
      rollRadps,
      pitchRadps,
      VerticalMode.Throttle,
      throttle
    ).withYawRate(yawRadps)

  /** `moveByMotorPWMs`: the rotors' controls, 0 to 1, in AirSim's order; the flight controller is bypassed.
    */
  def rotors(frontRight: Double, rearLeft: Double, frontLeft: Double, rearRight: Double): Setpoint =
    Setpoint(
      HorizontalMode.Rotors,
      frontRight,
      rearLeft,
      VerticalMode.Throttle,
      frontLeft,
      YawMode.Rate,
      rearRight
    )
