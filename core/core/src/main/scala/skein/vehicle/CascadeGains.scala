package skein.vehicle

/** Gains of one controller: on the error, on its integral and on its rate of change. */
final case class Pid(p: Double, i: Double = 0, d: Double = 0)

/** Gains of the controllers of three axes, in the order of the loop. */
final case class AxisGains(first: Pid, second: Pid, third: Pid)

/** The gains that an AirSim client can set, controller by controller (`set…ControllerGains`). The defaults
  * are those of [[ControllerGains]], whose limits, throttle and discount still apply.
  *
  * @param rate gains for roll, pitch, yaw: torque command per rad/s. AirSim uses only the proportional gains
  * @param angle gains for roll, pitch, yaw: share of the maximum rate per rad
  * @param velocity gains for front, right, down (AirSim's x, y, z): share of the maximum tilt per m/s; down:
  *   command from −1 to 1 per m/s
  * @param position gains for north, east, down: share of the maximum speed per m
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
