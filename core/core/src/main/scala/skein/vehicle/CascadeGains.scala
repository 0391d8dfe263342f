package skein.vehicle

/** Gains of one controller: of the error, of its integral and of its rate of change. */
final case class Pid(p: Double, i: Double = 0, d: Double = 0)

/** Gains of one controller for each of three axes, in the order of the loop. */
final case class AxisGains(first: Pid, second: Pid, third: Pid)

/** The gains that AirSim lets a client set, controller by controller (`set…ControllerGains`). The defaults
  * are those of [[ControllerGains]], whose limits, throttle and discount still apply.
  *
  * @param rate roll, pitch, yaw: torque command per rad/s. AirSim takes the proportional gains only and
  *   ignores the others
  * @param angle roll, pitch, yaw: share of the greatest rate per rad
  * @param velocity front, right, down (AirSim says x, y, z): share of the greatest tilt per m/s; down: out of
  *   −1 … 1 per m/s
  * @param position north, east, down: share of the greatest speed per m
  */
final case class CascadeGains(
    rate: AxisGains = CascadeGains.uniform(Pid(0.25)),
    angle: AxisGains = CascadeGains.uniform(Pid(2.5)),
    velocity: AxisGains = AxisGains(Pid(0.2), Pid(0.2), Pid(2.0, 2.0)),
    position: AxisGains = CascadeGains.uniform(Pid(0.25))
)

object CascadeGains:
  val Default: CascadeGains = CascadeGains()

  private def uniform(pid: Pid): AxisGains = AxisGains(pid, pid, pid)
