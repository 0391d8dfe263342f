package skein.autopilot

import skein.mavlink.FlightMode
import skein.units.GeoLocation

/** The part of an autopilot's state that telemetry reports. */
trait Status:
  /** MAVLink's system number, 1 to 255 */
  def system: Int

  def home: GeoLocation
  def mode: FlightMode
  def isArmed: Boolean
  def mission: Mission
