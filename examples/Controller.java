// SPDX-License-Identifier: MIT
// A stranger's controller: PD on the motors, against the messages alone. The law is in torque().
import java.util.TreeMap;
import java.util.concurrent.CountDownLatch;
import lcm.lcm.LCM;
import mixloop.command_t;
import mixloop.reference_t;
import mixloop.sim_control_t;
import mixloop.state_t;

class Controller {
  static final double[] KP = {100, 25, 25}, KV = {1, 0.5, 0.5};

  static double torque(int i, double psi, double psid, double psiD, double psidD) {
    return KP[i] * (psiD - psi) + KV[i] * (psidD - psid);
  }

  final LCM bus;
  final CountDownLatch done = new CountDownLatch(1);
  final TreeMap<Long, reference_t> references = new TreeMap<>();
  state_t state;

  Controller(LCM bus) {
    this.bus = bus;
    bus.subscribe("MIXLOOP_(STATE|REFERENCE|SIM_CONTROL)", (lcm, channel, in) -> {
      try {
        if (channel.endsWith("_STATE")) take(new state_t(in));
        else if (channel.endsWith("_REFERENCE")) take(new reference_t(in));
        else if (new sim_control_t(in).action == sim_control_t.ACTION_END) done.countDown();
      } catch (java.io.IOException damaged) {
        System.err.println("dropped a message on " + channel);
      }
    });
  }

  void take(state_t message) {
    state = message;
    answer();
  }

  void take(reference_t reference) {
    references.put(reference.seq, reference);
    references.headMap(reference.seq - 10).clear();
    if (state != null && reference.seq == state.seq) answer();
  }

  /** STATE(k) by COMMAND(k), once REFERENCE(k) is there; a repeated state gets the same answer. */
  void answer() {
    reference_t desired = state == null ? null : references.get(state.seq);
    if (desired == null || state.n != 3 || desired.session != state.session) return;
    command_t command = new command_t();
    command.n = state.n;
    command.utime = state.utime;
    command.seq = state.seq;
    command.session = state.session;
    command.config = state.config;
    command.tau_commanded = new double[state.n];
    for (int i = 0; i < state.n; ++i)
      command.tau_commanded[i] = torque(i, state.psi_measured[i], state.psid_measured[i],
                                        desired.psi_desired[i], desired.psid_desired[i]);
    bus.publish("MIXLOOP_COMMAND", command);
  }

  public static void main(String[] arguments) throws Exception {
    String url = System.getenv("LCM_DEFAULT_URL");
    Controller controller = new Controller(new LCM(url != null ? url : "udpm://239.255.76.67:7667?ttl=0"));
    controller.done.await();
    System.exit(0);
  }
}
