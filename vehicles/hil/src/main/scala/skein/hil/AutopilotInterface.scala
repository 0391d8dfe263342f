package skein.hil

import skein.units.Span
import skein.vehicle.Setpoint

/** The simulator's side of one autopilot's interface: what the autopilot sends goes in, its rotors' controls
  * and what is sent to it come out. It says how far physics may run, and is then given the sensors of that
  * time. Does no I/O and knows no clock; times are those since the simulator's start. Not thread-safe.
  */
trait AutopilotInterface:
  /** Takes in a piece of a stream, or a datagram. Whatever cannot be read is counted and changes nothing.
    *
    * @return what is answered at once
    */
  def hear(bytes: Array[Byte], up: Span): Vector[Array[Byte]]

  /** The rotors' controls as the autopilot wants them: front right, rear left, front left, rear right, 0 to 1.
    * All these autopilots count rotors and turn them like that.
    */
  def rotors: Setpoint

  /** Whether physics stands still until the autopilot has answered. */
  def isWaiting: Boolean

  /** Whether physics runs by the clock, and not as fast as the autopilot asks. */
  def isByClock: Boolean

  /** Where physics has to stop next for the sensors to be read, if it may run up to this time. */
  def stop(until: Span): Span

  /** The sensors at that stop.
    *
    * @return what is sent to the autopilot
    */
  def sense(truth: SensorTruth): Vector[Array[Byte]]

  /** The autopilot has not answered for so long that physics goes on without it, unless it shows that it is
    * about to: it is not waited for any more until it has answered for a while in time.
    */
  def giveUp(): Unit

  /** How often it was given up. */
  def losses: Int

  /** Messages that could not be read. */
  def damaged: Long

object AutopilotInterface:
  /** Of physics; all sensors are read at whole ones. */
  val Step: Span = Span.ofMillis(1)

  /** The last whole step by then. */
  private[hil] def onGrid(up: Span): Span = Span.ofNanos(up.toNanos - up.toNanos % Step.toNanos)

  val MotorsOff: Setpoint = Setpoint.rotors(0, 0, 0, 0)

  /** The first four of these, each brought into 0 to 1; what is no number is 0. */
  def rotors(controls: IndexedSeq[Double]): Setpoint =
    def control(index: Int) =
      val told = controls(index)
      if told > 0 then told.min(1) else 0.0
    Setpoint.rotors(control(0), control(1), control(2), control(3))
