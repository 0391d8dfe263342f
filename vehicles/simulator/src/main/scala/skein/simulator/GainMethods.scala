package skein.simulator

import skein.vehicle.{AxisGains, CascadeGains, Pid}

/** Functions that set the gains of a vehicle's flight controller. Each takes the proportional gains of three
  * axes, then the integral ones, then the derivative ones. All controllers then restart, as in AirSim. Gains
  * outlive a reset.
  */
private[simulator] object GainMethods extends MethodList:
  import ServerMethod.*

  gains("setAngleRateControllerGains")((set, axes) => set.copy(rate = axes))
  gains("setAngleLevelControllerGains")((set, axes) => set.copy(angle = axes))
  gains("setVelocityControllerGains")((set, axes) => set.copy(velocity = axes))
  gains("setPositionControllerGains")((set, axes) => set.copy(position = axes))

  /** Greatest gain accepted; AirSim's own are up to 2.5. */
  private val Largest = 1000f

  private def gains(method: String)(change: (CascadeGains, AxisGains) => CascadeGains): Unit =
    many[(Seq[Float], Seq[Float], Seq[Float], String)](method):
      case (simulation, (p, i, d, name)) =>
        multirotor(simulation, name): (_, vehicle) =>
          // AirSim reads past the end of a shorter one.
          if Seq(p, i, d).exists(_.size < 3) then
            CallOutcome.Threw("gains are three lists of three numbers: P, I, D")
          else if Seq(p, i, d).exists(_.exists(gain => math.abs(gain) > Largest)) then
            CallOutcome.Threw(s"gains are at most ${Largest.round}")
          else
            def axis(n: Int) = Pid(p(n), i(n), d(n))
            vehicle.tune(change(vehicle.gains, AxisGains(axis(0), axis(1), axis(2))))
            Nil
