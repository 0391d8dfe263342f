package skein.scenario

/** Names that no scenario may have: in `skein.fly`, a scenario's settings stand under its name, beside these
  * keys.
  */
private[skein] object ScenarioNames:
  val Taken: Set[String] =
    ("loops links duration period seed scenario scene policies only-policies predictor plant sensors wire " +
      "images moves-in-flight plan-in-packet knows strangers decentralised only between deadline solver " +
      "fallback planning").split(' ').toSet

  /** Why a scenario cannot have a name; None if it can. */
  def mistake(name: String): Option[String] =
    Option.when(Taken(name))(s"expected a scenario's name that is no setting of flights, got '$name'")
