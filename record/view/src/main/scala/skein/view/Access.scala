package skein.view

/** Who may look: a browser's page of another site may not, not even by a name that it has led to this
  * machine.
  *
  * @param origins pages of other sites that may look all the same, for example `https://app.foxglove.dev`
  */
final case class Access(port: Int, origins: Set[String] = Set.empty):
  private val hosts = Set("127.0.0.1", "localhost", "[::1]").map(name => s"$name:$port")

  /** Why a request is refused, if it is.
    *
    * @param host as the request names this server
    * @param origin of the page that asks; programs that are no browser send none
    */
  def refusal(host: String, origin: Option[String]): Option[String] =
    if !hosts(host) then Some(s"expected one of ${hosts.toVector.sorted.mkString(", ")} as the host")
    else
      origin.filterNot(from => origins(from) || hosts.exists(own => from == s"http://$own")).map(_ =>
        "pages of other sites may not look; start with --view-origin to let one"
      )
