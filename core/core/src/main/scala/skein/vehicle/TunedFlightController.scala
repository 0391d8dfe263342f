package skein.vehicle

/** A [[FlightController]] with separate gains, integrals and derivatives for every controller, like AirSim's
  * after a client has set gains. With [[CascadeGains.Default]] its results equal those of the plain one, to
  * the bit.
  *
  * A controller (`PidController`, `StdPidIntegrator`): out = clip(P·e + I-term + D·de/dt, −1, 1); I-term ←
  * clip(I-term · discount + dt·e·I, −1, 1), where only the vertical velocity's I-term is discounted. When the
  * mode of an axis changes, its controllers start again: the first update has neither integral nor
  * derivative, and the second computes the derivative from a previous error of zero, which causes a kick if D
  * is not zero. So does AirSim's controller.
  */
final class TunedFlightController(gains: ControllerGains, val cascade: CascadeGains, stepS: Double)
    extends FlightController(gains, stepS):
  import CascadeLoop.*

  private val pids: Array[Pid] = Array(
    // AirSim passes only the proportional gain to its rate controllers.
    Pid(cascade.rate.first.p),
    Pid(cascade.rate.second.p),
    Pid(cascade.rate.third.p),
    cascade.angle.first,
    cascade.angle.second,
    cascade.angle.third,
    cascade.velocity.second,
    cascade.velocity.first,
    cascade.position.first,
    cascade.position.second,
    cascade.position.third,
    cascade.velocity.third
  )

  override def update(state: QuadrotorState, setpoint: Setpoint): Unit =
    val memory = Option(state.cascadeMemory).getOrElse(CascadeMemory())
    state.cascadeMemory = memory
    memory.begin(setpoint)
    super.update(state, setpoint)

  override protected def respond(state: QuadrotorState, loop: Int, gain: Double, error: Double): Double =
    pid(state, loop, 1.0, error)

  override protected def climb(state: QuadrotorState, setpoint: Setpoint, error: Double): Double =
    pid(state, DownVelocity, gains.verticalDiscount, error)

  private def pid(state: QuadrotorState, loop: Int, discount: Double, error: Double): Double =
    val memory = state.cascadeMemory.nn
    val gain   = pids(loop)
    var slope  = 0.0
    if !memory.isNew(loop) then
      memory.integral(loop) = unit(memory.integral(loop) * discount + stepS * error * gain.i)
      slope = (error - memory.error(loop)) / stepS
      memory.error(loop) = error
    unit(gain.p * error + memory.integral(loop) + gain.d * slope)
