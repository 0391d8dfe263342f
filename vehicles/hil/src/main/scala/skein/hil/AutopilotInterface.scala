package skein.hil

import skein.units.Span
import skein.vehicle.Setpoint

/** The simulator's side of one autopilot's interface: the autopilot's messages go in; rotor controls and
  * answers come out. It states how far physics may advance, and then receives the sensors of that time. Does
  * no I/O and knows no clock; times are since the simulator's start. Not thread-safe.
  */
trait AutopilotInterface:
  /** Reads a piece of a stream, or a datagram. Unreadable input is counted and changes nothing.
    *
    * @return the immediate answers
    */
  def hear(bytes: Array[Byte], up: Span): Vector[Array[Byte]]

  /** The autopilot's rotor controls: front right, rear left, front left, rear right, 0 to 1. All these
    * autopilots number and turn their rotors this way.
    */
  def rotors: Setpoint

  /** Whether physics waits for the autopilot's answer. */
  def isWaiting: Boolean

  /** Whether physics follows the clock rather than the autopilot's requests. */
  def isByClock: Boolean

  /** The next time at or before `until` at which physics must stop for a sensor reading. */
  def stop(until: Span): Span

  /** Takes the sensors at that stop.
    *
    * @return the messages to the autopilot
    */
  def sense(truth: SensorTruth): Vector[Array[Byte]]

  /** Is called when the autopilot has not answered for too long. Physics then continues without it, until it
    * has answered in time for a while. If the autopilot shows that it is about to answer, physics keeps
    * waiting.
    */
  def giveUp(): Unit

  def losses: Int

  def damaged: Long

object AutopilotInterface:
  /** Sensors are read at whole multiples of this step. */
  val Step: Span = Span.ofMillis(1)

  /** The last whole multiple of [[Step]] at or before `up`. */
  private[hil] def onGrid(up: Span): Span = Span.ofNanos(up.toNanos - up.toNanos % Step.toNanos)

  val MotorsOff: Setpoint = Setpoint.rotors(0, 0, 0, 0)

  /** The first four controls, each clamped to 0 to 1; NaN becomes 0. */
  def rotors(controls: IndexedSeq[Double]): Setpoint =
    def control(index: Int) =
      val told = controls(index)
      if told > 0 then told.min(1) else 0.0
    Setpoint.rotors(control(0), control(1), control(2), control(3))
