package skein.simulator

import skein.signal.Kinematics
import skein.units.*

/** A part of this process that receives the motion of a simulator's vehicles: see [[SimulatorServer.start]].
  */
trait Onlooker:
  /** Receives the vehicles' motions every 20 ms of simulated time, at exactly that time, without those of
    * which sensors have no reading then. Runs on the simulation's own thread, so it must return soon. It is
    * not called while the simulator is paused.
    *
    * @param at the present time, on the simulator's clock
    */
  def see(at: Instant, vehicles: Vector[SeenVehicle]): Unit

/** A vehicle's motion, as its sensors report it.
  *
  * @param kinematics world NED
  * @param accelerationNed m/s², without gravity
  */
final case class SeenVehicle(
    name: String,
    kinematics: Kinematics,
    accelerationNed: Vector3,
    location: GeoLocation
)
