// A result file of the size of a long well: 5 km, 1000 contacts (points and lines), to see how the page bears it. The
// numbers are made up to look like a snaking pipe; only their amount matters.

export function syntheticWell(contacts = 1000) {
  const length = 5000;
  const clearance = 0.05;
  const fields = Object.fromEntries(
    ['S', 's', 'x', 'y', 'z', 'delta1', 'delta2', 'phi', 'gap', 'pressure', 'F1', 'F2', 'F3', 'M1', 'M2', 'M3', 'kappa'].map((name) => [name, []]),
  );
  const radius = 1800; // vertical, then a bend to horizontal
  const kickoff = 1500;
  const axis = (S) => {
    const bent = Math.min(Math.max(S - kickoff, 0) / radius, Math.PI / 2);
    const after = Math.max(S - kickoff - radius * (Math.PI / 2), 0);
    return {
      R: [radius * (1 - Math.cos(bent)) + after, 0, Math.min(S, kickoff) + radius * Math.sin(bent)],
      D1: [Math.cos(bent), 0, -Math.sin(bent)],
      D2: [0, 1, 0],
      curvature: bent > 0 && bent < Math.PI / 2 ? 1 / radius : 0,
    };
  };
  const spacing = length / (contacts + 1);
  const list = [];
  for (let i = 0; i < contacts; ++i) {
    const S = spacing * (i + 1);
    const line = i % 5 === 0;
    const half = line ? 0.2 * spacing : 0;
    const angle = -0.5 * Math.PI + (i % 2 ? 0.4 : -0.4);
    const force = 500 + 400 * Math.sin(i / 37) + i / 3;
    list.push({
      kind: line ? 'line' : 'point', start: S - half, end: S + half, s_start: S - half, s_end: S + half, angle_start: angle, angle_end: angle,
      force_start: line ? force / 4 : null, force_end: line ? force / 4 : null, force_distributed: line ? force / 2 : null, force,
      force_vector: [0, force * Math.cos(angle), force * Math.sin(angle)],
      pressure_min: line ? 10.5 : null, pressure_max: line ? force / spacing : null, pressure_mid: line ? force / spacing / 1.5 : null,
    });
  }
  const rows = 10 * contacts;
  for (let row = 0; row <= rows; ++row) {
    const S = (length * row) / rows;
    const phase = (Math.PI * S) / spacing;
    const away = Math.abs(Math.sin(phase));
    const angle = -0.5 * Math.PI + 0.4 * Math.cos(phase);
    const { R, D1, D2 } = axis(S);
    const d = [clearance * (1 - 0.3 * away) * Math.cos(angle), clearance * (1 - 0.3 * away) * Math.sin(angle)];
    const put = (name, value) => fields[name].push(value);
    put('S', S), put('s', S * 1.0000123), put('phi', 0.001 * phase), put('gap', 0.3 * clearance * away);
    R.forEach((r, k) => put('xyz'[k], r + d[0] * D1[k] + d[1] * D2[k]));
    put('delta1', d[0]), put('delta2', d[1]), put('pressure', away < 0.3 ? 100 * (0.3 - away) : 0);
    put('F1', 300 * Math.sin(phase)), put('F2', 200 * Math.cos(phase)), put('F3', -5e4 + 40 * S);
    put('M1', 900 * Math.sin(phase / 2)), put('M2', 700 * Math.cos(phase / 2)), put('M3', -4e3 + S / 5), put('kappa', 1e-3 * (1 + away));
  }
  const tube = { side: 'inside', rod_radius: 0.0635 };
  for (const name of ['S', 'x', 'y', 'z', 'D1x', 'D1y', 'D1z', 'D2x', 'D2y', 'D2z', 'clearance', 'curvature']) tube[name] = [];
  for (let i = 0; i <= 800; ++i) {
    const S = (length * i) / 800;
    const { R, D1, D2, curvature } = axis(S);
    tube.S.push(S), tube.clearance.push(clearance), tube.curvature.push(curvature);
    ['x', 'y', 'z'].forEach((name, k) => (tube[name].push(R[k]), tube[`D1${name}`].push(D1[k]), tube[`D2${name}`].push(D2[k])));
  }
  const certificate = { equilibrium: 3e-9, gap_min: 0, reaction_min: 0.01, curvature_max: -0.1, continuity: 1e-12, balance: 2e-13, invariant_spread: 0, error: 4e-10, strain_max: 1e-4, phase_multiplier: 0 };
  const segments = list.filter((c) => c.kind === 'line').map((c) => ({ kind: 'line', start: c.start, end: c.end }));
  const step = {
    parameter: null, status: 'converged', message: '', rod_length: length, axial_force_start: -5e4, axial_force_end: 1.5e5, torque_start: -4000, torque_end: -3000, push: 5e4,
    contacts: list, segments, stability: 'stable', branch: 'made up', certificate, effort: { newton_iterations: 1, factorisations: 1, patterns_tried: 1, wall_seconds: 1 }, fields, state: [],
  };
  return {
    tendril: '0.0.0', result_schema: 1,
    case: { file: 'synthetic.toml', title: 'A well with many contacts', units: 'si', resolved: { units: 'm, N, N m, rad', body_force: [0, 0, 250], axis_length: length, clearance_start: clearance, clearance_end: clearance } },
    status: 'converged', message: '', interrupted: false, notes: [], tube, steps: [step], events: [], trace: [],
  };
}
