package skein.link

/** The links that a fault affects. */
enum Where:
  case Everywhere

  /** All links to and from a host. With [[Fault.Silence]]: the host is lost. */
  case Host(name: String)

  case Link(client: String, server: String)

/** A fault of a network: its links, its time, and its duration. */
final case class NetworkFault(where: Where, timed: TimedFault)

/** The links between the hosts of a [[MemoryNetwork]].
  *
  * @param link the link between any two hosts without an entry in `links`
  * @param links links by the client's and the server's host
  * @param faults faults in addition to those of the links' own profiles
  */
final case class NetworkPlan(
    link: LinkProfile = LinkProfile.none,
    links: Map[(String, String), LinkProfile] = Map.empty,
    faults: Seq[NetworkFault] = Nil
):

  /** The link from a client's host to a server's, with all faults that affect it. A host reaches itself
    * without delay or fault.
    */
  private[link] def between(client: String, server: String): LinkProfile =
    if client == server then LinkProfile.none
    else
      val own       = links.getOrElse((client, server), link)
      val concerned = faults.collect:
        case NetworkFault(Where.Everywhere, timed)                                     => timed
        case NetworkFault(Where.Host(name), timed) if name == client || name == server => timed
        case NetworkFault(Where.Link(`client`, `server`), timed)                       => timed
      own.copy(faults = own.faults.copy(schedule = own.faults.schedule ++ concerned))
