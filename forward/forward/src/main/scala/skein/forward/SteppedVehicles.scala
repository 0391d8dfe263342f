package skein.forward

import skein.units.{Quaternion, Vector3}

/** A response whose vehicles many worlds step side by side, in equal whole steps, faster than one by one. The
  * results equal those of vehicles created one by one.
  */
trait SteppedResponse extends VelocityResponse:
  def stepS: Double

  /** Time for which they have hovered when a flight starts, s: decides the phase of the steps. */
  def hoveredS: Double

  /** This number of vehicles, for use by one thread. */
  def together(vehicles: Int): SteppedVehicles

/** Vehicles that are stepped together; places count from 0. World frame NED, positions from each vehicle's
  * start. Mutable.
  */
trait SteppedVehicles:
  /** Limits simulation to the first vehicles from now on. */
  def use(vehicles: Int): Unit

  /** Sets a vehicle to hover at its start, settled at `downM` (NED). */
  def hover(place: Int, downM: Double): Unit

  /** Commands `moveByVelocityZ`, m/s and m, from the next step on. */
  def command(place: Int, northMps: Float, eastMps: Float, downM: Float): Unit

  def step(): Unit

  def x(place: Int): Double
  def y(place: Int): Double
  def z(place: Int): Double

  def vx(place: Int): Double
  def vy(place: Int): Double
  def vz(place: Int): Double

  def ax(place: Int): Double
  def ay(place: Int): Double
  def az(place: Int): Double

  def orientation(place: Int): Quaternion

  def angularVelocityFrd(place: Int): Vector3
