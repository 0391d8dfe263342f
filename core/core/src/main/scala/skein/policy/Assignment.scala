package skein.policy

/** Assigns an opponent to every agent: the nearest of its rivals; among equally near rivals, the first. Live
  * loops, virtual time and forward simulation share this rule. Agents are identified by their index in a
  * scenario.
  *
  * @param rivals indices of each agent's rivals, at least one, ascending; a single rival is assigned
  *   permanently. An agent that flies alone is its own opponent
  */
final case class Assignment(rivals: Vector[Vector[Int]]):
  for (mine, self) <- rivals.zipWithIndex do
    require(
      mine.nonEmpty && mine.forall(other =>
        (other != self || rivals.size == 1) && rivals.indices.contains(other)
      ),
      s"agent $self needs rivals among the others of ${rivals.size}, got ${mine.mkString(", ")}"
    )

  private val byAgent = rivals.map(_.toArray).toArray

  /** The opponent of an agent at present distances.
    *
    * @param distanceM distance of an agent from agent `self`, m; not evaluated if there is a single rival
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
