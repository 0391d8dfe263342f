package skein.simulator

import skein.airsim.wire.*
import skein.units.*

/** AirSim's default GPS (`GpsSimple`): silent for its first second, its dilutions of precision falling from
  * 100 to 0.1 with a time constant of 0.9 s, so that it has a fix in three dimensions after some 3.2 s. A
  * reset restarts the dilutions, and does not silence it. It reports the current state as sensed; AirSim's is
  * 0.2 s late and updates every 20 ms.
  */
private[simulator] object Gps:
  def read(vehicle: SimulatedVehicle, at: Instant): GpsData =
    if !vehicle.hasGps(at) then Silent
    else
      val up       = vehicle.upFor(at).toSeconds
      val dilution = Final + (Initial - Final) * StrictMath.exp(-up / TimeConstantS)
      val seen     = vehicle.sensed(at)
      val report   = GnssReport(
        GeoPoint(vehicle.home.locate(seen.motion.positionNed)),
        dilution.toFloat,
        dilution.toFloat,
        Vector3r(seen.motion.velocityNed),
        if dilution <= Most3d then Fix3d else if dilution <= Most2d then Fix2d else NoFix,
        Instant.ofNanos(seen.at.toNanos / 1000)
      )
      GpsData(seen.at, report, is_valid = true)

  private val Initial       = 100.0
  private val Final         = 0.1
  private val TimeConstantS = 0.9
  private val Most3d        = 3.0
  private val Most2d        = 4.0
  private val NoFix         = 0
  private val Fix2d         = 2
  private val Fix3d         = 3

  private val Silent: GpsData =
    GpsData(
      Instant.Epoch,
      GnssReport(GeoPoint(0, 0, 0), 0, 0, Vector3r.Zero, NoFix, Instant.Epoch),
      is_valid = false
    )
