package skein.policy

/** The role of a vehicle in a scenario, for example `Role("Scout")`. */
final case class Role(name: String):
  override def toString: String = name

object Role:
  val Pursuer: Role   = Role("Pursuer")
  val Evader: Role    = Role("Evader")
  val Leader: Role    = Role("Leader")
  val Follower: Role  = Role("Follower")
  val Traveller: Role = Role("Traveller")

  def opponentOf(role: Role): Role = if role == Pursuer then Evader else Pursuer

  private val ours = Vector(Pursuer, Evader, Leader, Follower, Traveller)

  /** The role with this name; letter case is ignored for Skein's own roles. */
  def parse(name: String): Role = ours.find(_.name.equalsIgnoreCase(name)).getOrElse(Role(name))
