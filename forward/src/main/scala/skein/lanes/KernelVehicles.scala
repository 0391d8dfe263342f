package skein.lanes

import skein.forward.SteppedVehicles
import skein.units.{Quaternion, Vector3}
import skein.vehicle.{Environment, Quadrotor}

/** AirSim's quadrotors by [[QuadrotorKernel]], in floats. */
private final class KernelVehicles extends SteppedVehicles:
  private val kernel = QuadrotorKernel()

  def use(vehicles: Int): Unit = kernel.use(vehicles)

  def hover(place: Int, downM: Double): Unit =
    kernel.hover(place, Vector3(0, 0, downM - Quadrotor.AirSim.hoverSagM(downM, Environment.Calm)))

  def command(place: Int, northMps: Float, eastMps: Float, downM: Float): Unit =
    kernel.command(place, northMps, eastMps, downM)

  def step(): Unit = kernel.fly(1)

  def x(place: Int): Double  = kernel.x(place)
  def y(place: Int): Double  = kernel.y(place)
  def z(place: Int): Double  = kernel.z(place)
  def vx(place: Int): Double = kernel.vx(place)
  def vy(place: Int): Double = kernel.vy(place)
  def vz(place: Int): Double = kernel.vz(place)
  def ax(place: Int): Double = kernel.ax(place)
  def ay(place: Int): Double = kernel.ay(place)
  def az(place: Int): Double = kernel.az(place)

  def orientation(place: Int): Quaternion     = kernel.orientation(place)
  def angularVelocityFrd(place: Int): Vector3 = kernel.angularVelocityFrd(place)
