package skein.search

import skein.forward.Delays
import skein.lanes.Engine

/** The engine that evaluates a team's candidates.
  *
  * @param isVirtual whether it is so slow that only a few candidates are evaluated per second
  */
enum TeamEngine(val isVirtual: Boolean, val vehicles: String, val model: String):
  /** Forward simulation with measures of quantities. */
  case Reduced(conditions: Conditions.Resolved, delays: Delays)
      extends TeamEngine(false, conditions.vehicle.description, conditions.vehicle.name)

  /** Simulation of whole flights, for measures that need them. */
  case Whole(flights: WholeFlights)
      extends TeamEngine(flights.engine.kind == Engine.Kind.Flights, flights.vehicles, flights.model)
