package skein.forward

import skein.units.{Quaternion, Vector3}

/** A response of vehicles that many worlds step side by side, all by the same whole steps, sooner than each
  * by itself. They fly as those that it creates one by one.
  */
trait SteppedResponse extends VelocityResponse:
  /** s */
  def stepS: Double

  /** How long they have hovered when a flight starts, s: where the grid of steps lies. */
  def hoveredS: Double

  /** So many of them, for one thread. */
  def together(vehicles: Int): SteppedVehicles

/** Vehicles that are stepped together; places count from 0. World frame NED, positions from each vehicle's
  * start. Mutable.
  */
trait SteppedVehicles:
  /** Flies no more than the first ones from now on. */
  def use(vehicles: Int): Unit

  /** Lets it hover at its start, settled at `downM` (NED). */
  def hover(place: Int, downM: Double): Unit

  /** `moveByVelocityZ`, m/s and m, from the next step on. */
  def command(place: Int, northMps: Float, eastMps: Float, downM: Float): Unit

  def step(): Unit

  /** m */
  def x(place: Int): Double
  def y(place: Int): Double
  def z(place: Int): Double

  /** m/s */
  def vx(place: Int): Double
  def vy(place: Int): Double
  def vz(place: Int): Double

  /** m/s² */
  def ax(place: Int): Double
  def ay(place: Int): Double
  def az(place: Int): Double

  def orientation(place: Int): Quaternion

  /** rad/s */
  def angularVelocityFrd(place: Int): Vector3
