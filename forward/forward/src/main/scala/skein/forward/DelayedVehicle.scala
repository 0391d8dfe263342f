package skein.forward

import scala.collection.mutable
import skein.policy.Action

/** A vehicle whose commands take effect after a dead time; until the first does, it rests at its start. At
  * most [[DelayedVehicle.Most]] commands may be pending. Mutable.
  */
private[skein] abstract class DelayedVehicle(deadTimeS: Double) extends Vehicle:
  import DelayedVehicle.*
  protected var startX, startY = 0.0
  private val coming           = mutable.ArrayDeque.empty[Coming]
  private var nowS             = 0.0
  private var isCommanded      = false

  /** Rests at its start, at this altitude, m down. */
  protected def rest(downM: Double): Unit

  /** Makes a command take effect; the first one ends the rest at the start. */
  protected def take(command: Coming, isFirst: Boolean): Unit

  /** Simulates up to a time, under the last command that took effect. */
  protected def fly(timeS: Double): Unit

  final def start(x: Double, y: Double, z: Double): Unit =
    startX = x; startY = y
    nowS = 0; isCommanded = false
    coming.clear()
    rest(z)

  final def act(action: Action): Unit =
    if coming.size == Most then
      throw IllegalStateException(s"more than $Most commands within the dead time of $deadTimeS s")
    val atS = nowS + deadTimeS
    coming += (action.byVelocity match
      case Action.Velocity(velocity, _)            => Coming(atS, velocity.x, velocity.y, velocity.z, 0)
      case Action.VelocityAt(north, east, down, _) => Coming(atS, north, east, down.value, 1)
      case _                                       => Coming(atS, 0, 0, 0, 0))

  final def advance(timeS: Double): Unit =
    while coming.nonEmpty && coming.head.atS <= timeS do
      take(coming.removeHead(), isFirst = !isCommanded)
      isCommanded = true
    if isCommanded then fly(timeS)
    nowS = timeS

private[skein] object DelayedVehicle:
  private val Most = 1 << 16

  /** A command and when it takes effect, s; the other parameters are those of
    * [[skein.vehicle.SpatialPlant.step]].
    */
  final case class Coming(atS: Double, northMps: Double, eastMps: Double, third: Double, holds: Double)
