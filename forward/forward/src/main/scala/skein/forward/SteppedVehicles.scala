package skein.forward

import skein.vehicle.QuadrotorState

/** A response whose vehicles can be stepped together in many worlds, in equal whole steps, faster than one by
  * one and with equal results.
  */
trait SteppedResponse extends VelocityResponse:
  def stepS: Double

  /** Time for which a vehicle has hovered when a flight starts, s; it determines the phase of the steps. */
  def hoveredS: Double

  /** Creates this number of vehicles, for use by one thread. */
  def together(vehicles: Int): SteppedVehicles

/** Vehicles that are stepped together, by index from 0. World frame NED; positions are relative to each
  * vehicle's start. Mutable.
  */
trait SteppedVehicles:
  /** Limits the simulation to the first vehicles, until the next call. */
  def use(vehicles: Int): Unit

  /** Makes a vehicle hover at its start, settled, `downM` below the origin (NED). */
  def hover(place: Int, downM: Double): Unit

  /** Commands `moveByVelocityZ`, m/s and m; takes effect at the next step. */
  def command(place: Int, northMps: Float, eastMps: Float, downM: Float): Unit

  def step(): Unit

  /** Copies at least a vehicle's motion at the end of the last step. */
  def read(place: Int, into: QuadrotorState): Unit
