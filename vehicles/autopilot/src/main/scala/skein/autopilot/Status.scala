package skein.autopilot

import skein.mavlink.FlightMode
import skein.units.GeoLocation

/** What an autopilot tells of itself. */
trait Status:
  /** 1 to 255 */
  def system: Int

  /** Where its own frame has its origin. */
  def home: GeoLocation
  def mode: FlightMode
  def isArmed: Boolean
  def mission: Mission
