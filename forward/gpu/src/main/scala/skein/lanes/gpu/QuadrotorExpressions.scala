package skein.lanes.gpu

import skein.gpu.{Ptx, PtxExpressions, Variables}
import skein.lanes.plant.QuadrotorLanes

/** Generates a quadrotor's step in a kernel, equal to the step compiled by [[QuadrotorLanes]]. */
private[gpu] object QuadrotorExpressions:
  /** Generates one step.
    *
    * @param state variables of the components of [[QuadrotorLanes.rows]]
    * @param goal variables of the command: velocity north and east, m/s, and position down, m
    */
  def step(code: Ptx, lanes: QuadrotorLanes, state: Variables, goal: Variables): Unit =
    import lanes.{formula, rows}
    state.take(PtxExpressions.write(code, formula.bound.nodes)(
      place =>
        val input = formula.bound.inputs(place)
        if input < rows.size then state(input) else goal(input - rows.size)
      ,
      number => code.constant(formula.parameters(number).toFloat)
    ))
