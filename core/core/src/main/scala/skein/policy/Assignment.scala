package skein.policy

/** The opponent of every agent: the nearest of its rivals, the first of equals. One rule for live loops,
  * virtual time and forward simulation. Agents are numbered by their places in a scenario.
  *
  * @param rivals of each agent, at least one, in ascending order; with a single one the agent is assigned for
  *   good. A single agent is its own opponent
  */
final case class Assignment(rivals: Vector[Vector[Int]]):
  for (mine, self) <- rivals.zipWithIndex do
    require(
      mine.nonEmpty && mine.forall(other =>
        (other != self || rivals.size == 1) && rivals.indices.contains(other)
      ),
      s"agent $self needs rivals among the others of ${rivals.size}, came ${mine.mkString(", ")}"
    )

  private val byAgent = rivals.map(_.toArray).toArray

  /** The opponent of an agent by the present distances.
    *
    * @param distanceM of an agent from agent `self`; not evaluated if there is a single rival
    */
  def opponentOf(self: Int, distanceM: Int => Double): Int =
    val mine    = byAgent(self)
    var nearest = mine(0)
    if mine.length > 1 then
      var least = distanceM(nearest)
      var i     = 1
      while i < mine.length do
        val distance = distanceM(mine(i))
        if distance < least then
          least = distance
          nearest = mine(i)
        i += 1
    nearest
