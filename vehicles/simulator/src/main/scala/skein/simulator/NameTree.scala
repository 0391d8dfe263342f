package skein.simulator

/** A parsed `NamePattern`.
  *
  * @param size number of instructions in its `NameProgram`
  */
private[simulator] enum NameTree(val size: Long):
  case Letter(is: Char => Boolean)         extends NameTree(1)
  case Place(is: (String, Int) => Boolean) extends NameTree(1)
  case InOrder(parts: Vector[NameTree])    extends NameTree(parts.map(_.size).sum)
  case OneOf(choices: Vector[NameTree])    extends NameTree(choices.map(_.size + 2).sum)
  case Times(what: NameTree, least: Int, most: Option[Int])
      extends NameTree(((what.size + 2) * most.getOrElse(least + 1).max(1)).min(1_000_000))
